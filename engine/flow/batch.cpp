#include "engine/flow/batch.h"

#include <algorithm>
#include <atomic>
#include <optional>
#include <thread>

#include "engine/base/parallel_for.h"
#include "engine/flow/batch_branch.h"

namespace catena::flow {

namespace {

constexpr double kLapGap = 0.01;           ///< voxels
constexpr double kByHandTolerance = 1e-8;  ///< of the exact marcher's pieces: errors grow near saddles

using Slots = std::vector<std::optional<Result<CurvePtr>>>;

std::vector<Result<CurvePtr>> taken(Slots& slots) {
  std::vector<Result<CurvePtr>> results;
  results.reserve(slots.size());
  for (auto& slot : slots) results.push_back(std::move(*slot));
  return results;
}

/// One worker a core; each takes the next seeds until none is left.
void on_all_cores(std::size_t most, const std::function<void()>& worker) {
  const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
  parallel_for(std::min(cores, most), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) worker();
  });
}

/// The seeds in Morton order: lines that start near each other run together, through bricks that the cache holds.
std::vector<std::uint32_t> along_curve(const Flow& flow, std::span<const Vec3> seeds) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
  keys.reserve(seeds.size());
  const field::Box& box = flow.field->index_box();
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const Vec3 place = flow.field->mapping().index_from_world(seeds[i]) - box.lo;
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = place[axis] / 4;
      const auto n = static_cast<std::uint64_t>(x > 0 && x < 1048576 ? x : 0);
      for (int bit = 0; bit < 20; ++bit) key |= (n >> bit & 1) << (3 * bit + axis);
    }
    keys.emplace_back(key, static_cast<std::uint32_t>(i));
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order;
  order.reserve(keys.size());
  for (const auto& key : keys) order.push_back(key.second);
  return order;
}

/// The lanes of one core: each follows one direction of one line at a time.
class Worker {
 public:
  Worker(const VelocityBricks& bricks, const Flow& flow, const BatchOptions& options, std::span<const Vec3> seeds,
         std::span<const std::uint32_t> order, std::atomic<std::size_t>& next, Slots& slots)
      : bricks_(bricks), flow_(flow), seeds_(seeds), order_(order), next_(next), slots_(slots) {
    const double tolerance = options.tolerance * flow.field->length() / flow.field->longest_edge();
    control_.tolerance2 = static_cast<float>(tolerance * tolerance);
    control_.longest_step = static_cast<float>(options.longest_step);
    trace_.length = options.length;
    trace_.max_knots = options.max_knots;
    trace_.tolerance = trace_.hermite_tolerance = std::min(options.tolerance, kByHandTolerance);
    trace_ = filled_options(flow, trace_);
    lap_gap_ = std::max(kLapGap * flow.field->longest_edge(), 10 * options.tolerance * flow.field->length());
    for (int i = 0; i < kLanes; ++i) rest(i);
  }

  void run() {
    for (int i = 0; i < kLanes; ++i) begin_next(i);
    while (busy_ > 0) {
      step_lanes(bricks_, control_, group_);
      for (int i = 0; i < kLanes; ++i)
        if (lanes_[i].branch && !lanes_[i].branch->take(group_, i)) end_branch(i);
    }
  }

 private:
  struct Lane {
    std::optional<BatchBranch> branch;
    std::size_t seed = 0;
    Vec3 tangent{0.0};
    Branch forward, backward;  ///< these and the steps: memory that is used again
    std::vector<RawStep> steps;
  };

  /// An idle lane stands still at a legal place.
  void rest(int i) {
    group_.q[i] = Double4{1.5, 1.5, 1.5, 0};
    group_.k[i] = Float4{};
    group_.h[i] = 0;
  }

  void begin_next(int i) {
    for (;;) {
      const std::size_t turn = next_.fetch_add(1, std::memory_order_relaxed);
      if (turn >= order_.size()) return rest(i);
      const std::size_t at = order_[turn];
      const auto tangent = seed_tangent(flow_, seeds_[at]);
      if (!tangent) {
        slots_[at] = tangent.error();
        continue;
      }
      Lane& lane = lanes_[i];
      lane.seed = at;
      lane.tangent = *tangent;
      ++busy_;
      begin_branch(i, 1);
      return;
    }
  }

  void begin_branch(int i, double sign) {
    Lane& lane = lanes_[i];
    lane.branch.emplace(bricks_, flow_, trace_, lap_gap_, seeds_[lane.seed], lane.tangent, sign, lane.steps,
                        sign > 0 ? lane.forward : lane.backward);
    if (!lane.branch->start(group_, i)) end_branch(i);
  }

  void end_branch(int i) {
    Lane& lane = lanes_[i];
    const bool ahead = lane.branch->sign() > 0;
    lane.branch.reset();
    if (ahead && lane.forward.end.end != End::lap) return begin_branch(i, -1);
    slots_[lane.seed] = sewn(flow_, seeds_[lane.seed], lane.forward, lane.backward);
    --busy_;
    begin_next(i);
  }

  const VelocityBricks& bricks_;
  Flow flow_;
  TraceOptions trace_;
  StepControl control_;
  double lap_gap_ = 0;
  std::span<const Vec3> seeds_;
  std::span<const std::uint32_t> order_;
  std::atomic<std::size_t>& next_;
  Slots& slots_;
  LaneGroup group_{};
  Lane lanes_[kLanes];
  int busy_ = 0;
};

}  // namespace

BatchTracer::BatchTracer(const Flow& flow, const BatchOptions& options) : flow_(flow), options_(options) {
  const field::VectorGrid* grid = flow.field->grid();
  if (grid == nullptr || flow.line) return;
  const Vec3 size = grid->index_box().hi - grid->index_box().lo;
  if (size.x >= 1 && size.y >= 1 && size.z >= 1) bricks_ = std::make_unique<VelocityBricks>(*grid);
}

BatchTracer::~BatchTracer() = default;

std::vector<Result<CurvePtr>> BatchTracer::trace(std::span<const Vec3> seeds) const {
  if (!bricks_) {
    TraceOptions options;
    options.length = options_.length;
    options.max_knots = options_.max_knots;
    options.tolerance = options.hermite_tolerance = options_.tolerance;
    return trace_each(flow_, seeds, options);
  }
  const std::vector<std::uint32_t> order = along_curve(flow_, seeds);
  Slots slots(seeds.size());
  std::atomic<std::size_t> next{0};
  on_all_cores((seeds.size() + kLanes - 1) / kLanes, [&] { Worker(*bricks_, flow_, options_, seeds, order, next, slots).run(); });
  return taken(slots);
}

std::vector<Result<CurvePtr>> trace_each(const Flow& flow, std::span<const Vec3> seeds, const TraceOptions& options) {
  Slots slots(seeds.size());
  std::atomic<std::size_t> next{0};
  on_all_cores(seeds.size(), [&] {
    for (std::size_t at; (at = next.fetch_add(1, std::memory_order_relaxed)) < seeds.size();)
      slots[at] = flow::trace(flow, seeds[at], options);
  });
  return taken(slots);
}

}  // namespace catena::flow
