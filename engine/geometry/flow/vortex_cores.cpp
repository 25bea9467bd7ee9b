// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/vortex_cores.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <tuple>

#include "engine/base/memory_limit.h"
#include "engine/base/threads.h"
#include "engine/geometry/flow/vortex_core_tracer.h"

namespace catena::flow {
namespace {

constexpr int kBlock = 16;             // cells per axis of the blocks that are searched in parallel
constexpr int kFormulaCells = 48;      // cells per axis of a formula's domain
constexpr double kFormulaStep = 5e-4;  // step of the differences for formulas, as a fraction of L
constexpr double kNear = 1.5;          // cells: maximum Newton step to a core
constexpr double kOnCore = 0.25;       // cells: a point this close is on a core
constexpr std::size_t kSeedsABlock = 256, kMinPlaces = 64;
constexpr double kVoxelsOfLine = 6, kPartOfLength = 0.02;  // default minimum length of a line, in voxels and as a fraction of L
constexpr double kJoined = 2.5;                            // cells: maximum gap that is closed within a line
constexpr int kFaired = 6;                                 // knots on each side in the least-squares smoothing of a grid's core lines
constexpr std::size_t kMaxPlaces = 4'000'000;

/// Results of the search in a block of cells.
struct BlockSeeds {
  std::vector<CoreSeed> seeds;
  std::size_t turning = 0, on_core = 0;
  double fastest = 0;
};

class Scan {
 public:
  Scan(const field::VectorField& field, CoreCriterion criterion) : field_(field), criterion_(criterion) {
    const Vec3 lo = field.index_box().lo, hi = field.index_box().hi;
    const Vec3 e = hi - lo;
    if (field.is_grid()) {
      const Mat3 edges = glm::inverse(field.mapping().index_from_world_linear);
      spacing_ = std::min({norm(edges[0]), norm(edges[1]), norm(edges[2])});
      for (int a = 0; a < 3; ++a) cells_[a] = static_cast<int>(std::lround(e[a]));
      cell_ = Vec3(1.0);
      scale_ = field.grid()->max_magnitude();
    } else {
      cell_ = e * (1.0 / kFormulaCells);
      spacing_ = std::min({cell_.x, cell_.y, cell_.z});
      cells_[0] = cells_[1] = cells_[2] = kFormulaCells;
      field::Cursor cursor;
      for (int c = 0; c < 17 * 17 * 17; ++c) {
        const Vec3 at(lo.x + e.x * (c % 17) / 16, lo.y + e.y * (c / 17 % 17) / 16, lo.z + e.z * (c / 289) / 16);
        const field::VectorSample sample = field.sample(field.mapping().world_from_index(at), cursor);
        if (sample.inside && is_finite(sample.value)) scale_ = std::max(scale_, max_abs(sample.value));
      }
    }
    for (int a = 0; a < 3; ++a) blocks_[a] = static_cast<std::size_t>((cells_[a] + kBlock - 1) / kBlock);
  }

  double spacing() const { return spacing_; }
  double scale() const { return scale_; }
  std::size_t blocks() const { return blocks_[0] * blocks_[1] * blocks_[2]; }

  BlockSeeds look(std::size_t number) const {
    const int first[3] = {static_cast<int>(number % blocks_[0]) * kBlock, static_cast<int>(number / blocks_[0] % blocks_[1]) * kBlock,
                          static_cast<int>(number / blocks_[0] / blocks_[1]) * kBlock};
    int count[3];
    for (int a = 0; a < 3; ++a) count[a] = std::min(kBlock, cells_[a] - first[a]);
    BlockSeeds out;
    if (field_.is_grid())
      look_at_nodes(first, count, out);
    else
      look_at_places(first, count, out);
    return out;
  }

 private:
  Vec3 middle(int i, int j, int k) const {
    return field_.mapping().world_from_index(field_.index_box().lo + Vec3(cell_.x * (i + 0.5), cell_.y * (j + 0.5), cell_.z * (k + 0.5)));
  }

  void offer(const Vec3& position, const CoreSample& sample, BlockSeeds& out) const {
    if (!sample.is_vortex) return;
    ++out.turning;
    const double distance = norm(sample.step);
    out.on_core += distance < kOnCore * spacing_;
    if (distance < kNear * spacing_ && out.seeds.size() < kSeedsABlock) out.seeds.push_back({position + sample.step, sample.axis});
  }

  void look_at_places(const int* first, const int* count, BlockSeeds& out) const {
    CoreField flow(field_, criterion_, scale_);
    for (int k = first[2]; k < first[2] + count[2]; ++k)
      for (int j = first[1]; j < first[1] + count[1]; ++j)
        for (int i = first[0]; i < first[0] + count[0]; ++i) {
          const Vec3 position = middle(i, j, k);
          offer(position, flow.sample_at(position), out);
        }
  }

  /// Searches the block's nodes; the gradient of each node is computed only once.
  void look_at_nodes(const int* first, const int* count, BlockSeeds& out) const {
    const field::VectorGrid& grid = *field_.grid();
    const Vec3 lo = grid.index_box().lo;
    NodeBlock nodes;
    nodes.read(grid, {static_cast<int>(lo.x) + first[0] - 1, static_cast<int>(lo.y) + first[1] - 1, static_cast<int>(lo.z) + first[2] - 1},
               kBlock + 3);
    if (nodes.is_empty()) return;
    constexpr int n = kBlock + 1;
    std::vector<Mat3> gradients(n * n * n);
    std::vector<bool> known(n * n * n, false);
    const auto at = [](int i, int j, int k) { return static_cast<std::size_t>(i + n * (j + n * k)); };
    for (int k = 0; k <= count[2]; ++k)
      for (int j = 0; j <= count[1]; ++j)
        for (int i = 0; i <= count[0]; ++i) known[at(i, j, k)] = nodes.gradient(i + 1, j + 1, k + 1, gradients[at(i, j, k)]);
    CoreField flow(field_, criterion_, scale_);
    const Mat3 linear = grid.mapping().index_from_world_linear * (0.125 / scale_);
    for (int k = 0; k < count[2]; ++k)
      for (int j = 0; j < count[1]; ++j)
        for (int i = 0; i < count[0]; ++i) {
          if (!nodes.has_cell(i + 1, j + 1, k + 1)) continue;
          CoreFlow cell_flow;
          bool all = true;
          for (int c = 0; c < 8 && all; ++c) {
            const int x = i + c % 2, y = j + c / 2 % 2, z = k + c / 4;
            all = known[at(x, y, z)];
            cell_flow.gradient += gradients[at(x, y, z)];
            cell_flow.v += nodes.value(x + 1, y + 1, z + 1);
          }
          if (!all) continue;
          cell_flow.gradient = cell_flow.gradient * linear;
          cell_flow.v *= 0.125 / scale_;
          const Vec3 position = middle(first[0] + i, first[1] + j, first[2] + k);
          offer(position, flow.evaluate(position, cell_flow), out);
        }
  }

  const field::VectorField& field_;
  CoreCriterion criterion_;
  Vec3 cell_{0.0};
  double spacing_ = 0, scale_ = 0;
  int cells_[3] = {0, 0, 0};
  std::size_t blocks_[3] = {0, 0, 0};
};

LineEnd end_at(const field::VectorField& field, const Vec3& position, const Vec3& previous, bool leaves) {
  if (!leaves) return {};
  field::Cursor cursor;
  const Vec3 outside_position = position + direction(position - previous) * (1e-3 * field.domain_length());
  const SampleStatus reason = field.is_grid() ? field.status_outside(outside_position, cursor) : SampleStatus::outside_box;
  return {Termination::boundary, reason == SampleStatus::ok ? SampleStatus::masked : reason};
}

double length_of(const CoreTrace& line) {
  double sum = 0;
  for (std::size_t k = 1; k < line.points.size(); ++k) sum += norm(line.points[k] - line.points[k - 1]);
  return sum;
}

double mean_swirl(const CoreTrace& line) {
  double sum = 0;
  for (const double swirl : line.swirls) sum += swirl;
  return sum / static_cast<double>(line.swirls.size());
}

Result<VortexCoresPtr> trace_cores(const field::VectorField& field, const CoreOptions& options) {
  const Scan scan(field, options.criterion);
  auto result = std::make_shared<VortexCores>();
  const bool grid = field.is_grid();
  result->spacing = grid ? 0.5 * scan.spacing() : kFormulaStep * field.domain_length();
  if (!(scan.scale() > 0) || !std::isfinite(scan.scale()) || scan.blocks() == 0) return VortexCoresPtr(result);
  CATENA_CHECK(check_memory_available("tracing vortex cores", static_cast<double>(scan.blocks()) * (kSeedsABlock * sizeof(CoreSeed)) / 4));

  std::vector<BlockSeeds> found(scan.blocks());
  parallel_for(found.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) found[k] = scan.look(k);
  });
  std::size_t turning = 0, on_core = 0;
  for (const BlockSeeds& block : found) {
    turning += block.turning;
    on_core += block.on_core;
  }
  result->holds_everywhere = turning >= kMinPlaces && 2 * on_core > turning;
  if (result->holds_everywhere) return VortexCoresPtr(result);

  CoreTracer tracer(field, options.criterion, scan.scale(), result->spacing, scan.spacing(), grid);
  std::vector<CoreTrace> traces;
  for (const BlockSeeds& block : found)
    for (const CoreSeed& seed : block.seeds) {
      CoreTrace line;
      if (tracer.trace(seed, line)) traces.push_back(std::move(line));
      if (tracer.point_count() > kMaxPlaces)
        return Error{fmt::format("has more than {} candidate points of vortex cores; a smoother field was expected", kMaxPlaces)};
    }
  join_traces(traces, kJoined * scan.spacing());

  // lines that are too short or too weak are noise
  const double min_length = options.min_length > 0 ? options.min_length
                            : grid                 ? kVoxelsOfLine * scan.spacing()
                                                   : kPartOfLength * field.domain_length();
  std::erase_if(traces, [&](const CoreTrace& line) { return length_of(line) < min_length; });
  double strongest = 0, fastest = 0;
  for (const CoreTrace& line : traces) {
    strongest = std::max(strongest, mean_swirl(line));
    for (const double swirl : line.swirls) fastest = std::max(fastest, swirl);
  }
  std::erase_if(traces, [&](const CoreTrace& line) { return mean_swirl(line) < options.min_swirl * strongest; });
  std::stable_sort(traces.begin(), traces.end(), [](const CoreTrace& a, const CoreTrace& b) { return length_of(a) > length_of(b); });
  for (const CoreTrace& line : traces) {
    const std::vector<Vec3> p = grid ? fair_points(line.points, line.closed, kFaired) : line.points;
    result->lines.push_back(spline_through(p, line.closed, end_at(field, p[0], p[1], line.first_exits_domain),
                                           end_at(field, p[p.size() - 1], p[p.size() - 2], line.last_exits_domain), field.domain_length()));
    std::vector<float>& swirls = result->swirls.emplace_back();
    for (const double swirl : line.swirls) swirls.push_back(static_cast<float>(swirl / fastest));
    if (line.closed) swirls.push_back(swirls.front());
  }
  return VortexCoresPtr(result);
}

}  // namespace

Result<VortexCoresPtr> find_vortex_cores(const field::VectorFieldPtr& field, const CoreOptions& options) {
  static std::mutex mutex;
  static std::map<std::pair<std::uint64_t, CoreOptions>, std::weak_ptr<const VortexCores>> all;
  const std::lock_guard lock(mutex);
  std::erase_if(all, [](const auto& entry) { return entry.second.expired(); });
  std::weak_ptr<const VortexCores>& known = all[{field->version(), options}];
  VortexCoresPtr cores = known.lock();
  if (cores) return cores;
  CATENA_TRY(cores, trace_cores(*field, options));
  known = cores;
  return cores;
}

}  // namespace catena::flow
