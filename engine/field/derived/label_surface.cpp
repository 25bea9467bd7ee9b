// SPDX-License-Identifier: MIT
#include "engine/field/derived/label_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "engine/base/threads.h"
#include "engine/field/grid/dense.h"

namespace catena::field {
namespace {

constexpr std::size_t kMaxLabelValues = 65536;
constexpr double kMaxLabelBlocks = 1 << 21;
constexpr float kHeldInside = 0.52f, kHeldOutside = 0.48f;

Index3 lowest(const ScalarGrid& grid) {
  const Vec3& lo = grid.index_box().lo;
  return {static_cast<int>(std::lround(lo.x)), static_cast<int>(std::lround(lo.y)), static_cast<int>(std::lround(lo.z))};
}
Index3 highest(const ScalarGrid& grid) {
  const Vec3& hi = grid.index_box().hi;
  return {static_cast<int>(std::lround(hi.x)), static_cast<int>(std::lround(hi.y)), static_cast<int>(std::lround(hi.z))};
}

Index3 minimum(const Index3& a, const Index3& b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Index3 maximum(const Index3& a, const Index3& b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

using Counts = std::map<double, LabelCount>;

void add_run(Counts& counts, double value, const Index3& lo, const Index3& hi, std::uint64_t voxels) {
  LabelCount& count = counts.try_emplace(value, LabelCount{value, 0, lo, hi}).first->second;
  count.voxels += voxels;
  count.lo = minimum(count.lo, lo);
  count.hi = maximum(count.hi, hi);
}

/// Adds the labels of up to eight slices to `counts`; returns false if the values are not labels: not integers, or too many different
/// ones.
bool count_layers(const ScalarGrid& map, const Index3& origin, const Index3& size, Counts& counts) {
  std::vector<float> values(static_cast<std::size_t>(size.x) * size.y * size.z);
  map.read_block(origin, size, values);
  std::size_t at = 0;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x;) {
        const float value = values[at];
        if (!(value == std::nearbyint(value)) || !std::isfinite(value)) return false;
        const int first = x;
        for (; x < size.x && values[at] == value; ++x) ++at;
        const int row = origin.y + y, layer = origin.z + z;
        add_run(counts, value, {origin.x + first, row, layer}, {origin.x + x - 1, row, layer}, static_cast<std::uint64_t>(x - first));
        if (counts.size() > kMaxLabelValues) return false;
      }
  return true;
}

std::vector<float> gaussian(double smooth) {
  const int radius = static_cast<int>(std::ceil(3 * smooth));
  std::vector<float> weights;
  double sum = 0;
  for (int i = -radius; i <= radius; ++i) sum += std::exp(-0.5 * i * i / (smooth * smooth));
  for (int i = -radius; i <= radius; ++i) weights.push_back(static_cast<float>(std::exp(-0.5 * i * i / (smooth * smooth)) / sum));
  return weights;
}

/// Smoothed indicator function chi of a set of labels over a box, slice by slice.
class Indicator {
 public:
  Indicator(const ScalarGrid& map, std::vector<double> labels, double smooth, const Index3& origin, const Index3& size)
      : map_(map), labels_(std::move(labels)), origin_(origin), size_(size), lo_(lowest(map)), hi_(highest(map)) {
    if (smooth > 0) weights_ = gaussian(smooth);
  }

  void read(int z, int layers, std::span<float> out) const {
    const int radius = static_cast<int>(weights_.size()) / 2;
    const std::size_t layer = static_cast<std::size_t>(size_.x) * size_.y;
    std::vector<float> indicator(layer * static_cast<std::size_t>(layers + 2 * radius), 0.f);
    parallel_for(static_cast<std::size_t>(layers + 2 * radius), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) mark(z - radius + static_cast<int>(k), std::span(indicator).subspan(k * layer, layer));
    });
    if (radius == 0) {
      std::copy_n(indicator.begin(), out.size(), out.begin());
      return;
    }
    std::vector<float> across(indicator.size());
    parallel_for(static_cast<std::size_t>(layers + 2 * radius), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) smooth_layer(&indicator[k * layer], &across[k * layer]);
    });
    parallel_for(static_cast<std::size_t>(layers), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        for (std::size_t i = 0; i < layer; ++i) {
          float sum = 0;
          for (std::size_t j = 0; j < weights_.size(); ++j) sum += weights_[j] * across[(k + j) * layer + i];
          const bool inside = indicator[(k + static_cast<std::size_t>(radius)) * layer + i] > 0;
          // removes rounding errors where chi is constant, 0 or 1
          if (sum < 1e-6f) sum = 0;
          if (sum > 1 - 1e-6f) sum = 1;
          out[k * layer + i] = inside ? std::max(sum, kHeldInside) : std::min(sum, kHeldOutside);
        }
    });
  }

 private:
  /// Computes one slice of chi before smoothing; outside the map it is 0.
  void mark(int z, std::span<float> out) const {
    const Index3 from = maximum({origin_.x, origin_.y, origin_.z + z}, lo_);
    const Index3 to = minimum({origin_.x + size_.x - 1, origin_.y + size_.y - 1, origin_.z + z}, hi_);
    const Index3 count{to.x - from.x + 1, to.y - from.y + 1, to.z - from.z + 1};
    if (count.x <= 0 || count.y <= 0 || count.z <= 0) return;
    std::vector<float> values(static_cast<std::size_t>(count.x) * count.y);
    map_.read_block(from, count, values);
    float last = 0;
    bool selected = is_wanted(last);
    std::size_t at = 0;
    for (int y = 0; y < count.y; ++y) {
      float* row = &out[static_cast<std::size_t>(from.y - origin_.y + y) * size_.x + static_cast<std::size_t>(from.x - origin_.x)];
      for (int x = 0; x < count.x; ++x, ++at) {
        if (values[at] != last) {
          last = values[at];
          selected = is_wanted(last);
        }
        row[x] = selected ? 1.f : 0.f;
      }
    }
  }

  bool is_wanted(float value) const { return std::binary_search(labels_.begin(), labels_.end(), static_cast<double>(value)); }

  /// Smooths one slice along x and y. At the borders of the box the result is 0: its margin is wider than the kernel reaches.
  void smooth_layer(const float* in, float* out) const {
    const int radius = static_cast<int>(weights_.size()) / 2;
    const auto nx = static_cast<std::size_t>(size_.x);
    std::vector<float> rows(nx * static_cast<std::size_t>(size_.y), 0.f);
    for (int y = 0; y < size_.y; ++y)
      for (int x = radius; x < size_.x - radius; ++x) {
        const float* from = in + static_cast<std::size_t>(y) * nx + (x - radius);
        float sum = 0;
        for (std::size_t j = 0; j < weights_.size(); ++j) sum += weights_[j] * from[j];
        rows[static_cast<std::size_t>(y) * nx + static_cast<std::size_t>(x)] = sum;
      }
    std::fill_n(out, rows.size(), 0.f);
    for (int y = radius; y < size_.y - radius; ++y)
      for (std::size_t j = 0; j < weights_.size(); ++j) {
        const float* from = &rows[(static_cast<std::size_t>(y - radius) + j) * nx];
        float* to = out + static_cast<std::size_t>(y) * nx;
        for (std::size_t x = 0; x < nx; ++x) to[x] += weights_[j] * from[x];
      }
  }

  const ScalarGrid& map_;
  std::vector<double> labels_;  ///< in increasing order
  Index3 origin_, size_, lo_, hi_;
  std::vector<float> weights_;
};

}  // namespace

std::optional<std::vector<LabelCount>> count_labels(const ScalarGrid& map) {
  const Index3 lo = lowest(map), hi = highest(map);
  const Index3 size{hi.x - lo.x + 1, hi.y - lo.y + 1, hi.z - lo.z + 1};
  constexpr int kLayers = 8;
  if (double(size.x) * size.y * size.z / 512 > kMaxLabelBlocks) return std::nullopt;
  Counts all;
  bool all_valid = true;
  std::mutex mutex;
  const auto slabs = static_cast<std::size_t>((size.z + kLayers - 1) / kLayers);
  parallel_for(slabs, 1, [&](std::size_t begin, std::size_t end) {
    Counts counts;
    bool valid = true;
    for (std::size_t s = begin; s < end && valid; ++s) {
      const int z = static_cast<int>(s) * kLayers;
      valid = count_layers(map, {lo.x, lo.y, lo.z + z}, {size.x, size.y, std::min(kLayers, size.z - z)}, counts);
    }
    const std::scoped_lock lock(mutex);
    all_valid = all_valid && valid;
    if (!all_valid) return;
    for (const auto& [value, count] : counts) add_run(all, value, count.lo, count.hi, count.voxels);
  });
  if (!all_valid || all.size() > kMaxLabelValues) return std::nullopt;
  std::vector<LabelCount> list;
  for (const auto& [value, count] : all) list.push_back(count);
  return list;
}

Result<std::shared_ptr<const ScalarGrid>> make_label_surface(const ScalarGrid& map, const std::vector<LabelCount>& counts,
                                                             const std::vector<double>& labels, double smooth, const std::string& name) {
  CATENA_ASSERT(!labels.empty() && smooth >= 0 && smooth <= kMaxLabelSmoothing);
  std::optional<LabelCount> set;
  std::vector<double> sorted_labels = labels;
  std::sort(sorted_labels.begin(), sorted_labels.end());
  for (const LabelCount& count : counts) {
    if (!std::binary_search(sorted_labels.begin(), sorted_labels.end(), count.value)) continue;
    if (!set) set = count;
    set->lo = minimum(set->lo, count.lo);
    set->hi = maximum(set->hi, count.hi);
  }
  CATENA_ASSERT(set.has_value());
  const int margin = 2 + static_cast<int>(std::ceil(3 * smooth));
  const Index3 origin{set->lo.x - margin, set->lo.y - margin, set->lo.z - margin};
  const Index3 size{set->hi.x + margin - origin.x + 1, set->hi.y + margin - origin.y + 1, set->hi.z + margin - origin.z + 1};
  CATENA_CHECK(check_dense_memory("the surface of \"" + name + "\"", size, 1, false));
  const Indicator indicator(map, sorted_labels, smooth, origin, size);
  const DenseSource source{size, false, [&](int z, int layers, std::span<float> values, std::span<std::uint8_t>) -> Outcome {
                             indicator.read(z, layers, values);
                             return Done{};
                           }};
  const Mapping& of = map.mapping();
  const Mapping mapping = Mapping::from_linear(of.world_from_index_linear, of.world_from_index(Vec3(origin.x, origin.y, origin.z)));
  return make_dense_grid<ScalarGrid>(name, mapping, source, "the surface of \"" + name + "\" ");
}

double label_at(const ScalarGrid& map, const Vec3& world) {
  Cursor cursor;
  const Vec3 index = map.mapping().index_from_world(world);
  if (!is_finite(index) || !map.index_box().contains(index, 1e-6)) return 0;
  const ScalarCell cell = map.cell(map.cell_base(index), cursor);
  double best = HUGE_VAL, label = 0;
  const Vec3 position = index - Vec3(cell.base.x, cell.base.y, cell.base.z);
  for (std::size_t n = 0; n < 8; ++n) {
    const Vec3 offset = position - Vec3(double(n & 1), double(n >> 1 & 1), double(n >> 2));
    if (cell.corner[n] == 0 || !std::isfinite(cell.corner[n]) || dot(offset, offset) > best) continue;
    best = dot(offset, offset);
    label = cell.corner[n];
  }
  return label;
}

}  // namespace catena::field
