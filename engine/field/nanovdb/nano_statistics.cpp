// SPDX-License-Identifier: MIT
#include "engine/field/nanovdb/nano_statistics.h"

#include <bit>
#include <cmath>
#include <limits>
#include <mutex>

#include "engine/base/threads.h"
#include "engine/field/nanovdb/nano_nodes.h"

namespace catena::field {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kGrain = 64;

std::uint64_t cube(std::int64_t edge) { return static_cast<std::uint64_t>(edge * edge * edge); }

GridStats empty_stats() {
  GridStats s;
  s.min = kInfinity;
  s.max = -kInfinity;
  s.component_min = Vec3(kInfinity);
  s.component_max = Vec3(-kInfinity);
  return s;
}

void merge(GridStats& s, const GridStats& t) {
  s.active_voxels += t.active_voxels;
  s.nan_count += t.nan_count;
  s.min = std::min(s.min, t.min);
  s.max = std::max(s.max, t.max);
  for (int a = 0; a < 3; ++a) {
    s.component_min[a] = std::min(s.component_min[a], t.component_min[a]);
    s.component_max[a] = std::max(s.component_max[a], t.component_max[a]);
  }
}

/// Extends the ranges by a value; returns false if the value is not finite.
bool widen(GridStats& s, float v) {
  if (!std::isfinite(v)) return false;
  s.min = std::min(s.min, static_cast<double>(v));
  s.max = std::max(s.max, static_cast<double>(v));
  return true;
}

bool widen(GridStats& s, const nanovdb::Vec3f& v) {
  const Vec3 components(v[0], v[1], v[2]);
  if (!is_finite(components)) return false;
  const double size = norm(components);
  s.min = std::min(s.min, size);
  s.max = std::max(s.max, size);
  for (int a = 0; a < 3; ++a) {
    s.component_min[a] = std::min(s.component_min[a], components[a]);
    s.component_max[a] = std::max(s.component_max[a], components[a]);
  }
  return true;
}

/// Sets the component ranges of a scalar grid to its value range.
void finish(GridStats& s, float) { s.component_min = Vec3(s.min), s.component_max = Vec3(s.max); }
void finish(GridStats&, const nanovdb::Vec3f&) {}

/// Extends the ranges by the 512 values of a leaf that all count, in SIMD lanes; NaN and infinities are omitted.
std::uint32_t widen_all(GridStats& s, const float* values) {
  constexpr int kLanes = 16;
  float lo[kLanes], hi[kLanes];
  std::uint32_t odd[kLanes]{};
  std::fill_n(lo, kLanes, std::numeric_limits<float>::infinity());
  std::fill_n(hi, kLanes, -std::numeric_limits<float>::infinity());
  for (int i = 0; i < 512; i += kLanes)
    for (int k = 0; k < kLanes; ++k) {
      const float v = values[i + k];
      const bool finite = std::fabs(v) <= std::numeric_limits<float>::max();
      const float low = finite ? v : std::numeric_limits<float>::infinity(), high = finite ? v : -std::numeric_limits<float>::infinity();
      lo[k] = low < lo[k] ? low : lo[k];
      hi[k] = high > hi[k] ? high : hi[k];
      odd[k] += finite ? 0 : 1;
    }
  std::uint32_t count = 0;
  for (int k = 0; k < kLanes; ++k) {
    count += odd[k];
    s.min = std::min(s.min, static_cast<double>(lo[k]));
    s.max = std::max(s.max, static_cast<double>(hi[k]));
  }
  return count;
}

std::uint32_t widen_all(GridStats& s, const nanovdb::Vec3f* values) {
  std::uint32_t count = 0;
  for (int i = 0; i < 512; ++i) count += widen(s, values[i]) ? 0 : 1;
  return count;
}

template <class T>
void add_leaf(GridStats& s, const typename NanoTypes<T>::Leaf& leaf, const MaskView* valid) {
  if (valid == nullptr && leaf.mValueMask.isOn()) {
    s.active_voxels += 512;
    s.nan_count += widen_all(s, leaf.mValues);
    return;
  }
  for (int x = 0; x < 8; ++x) {
    const std::uint64_t counted =
        leaf.mValueMask.template getWord<std::uint64_t>(x) & (valid ? valid->word(leaf.mBBoxMin, x) : ~std::uint64_t{0});
    s.active_voxels += static_cast<std::uint64_t>(std::popcount(counted));
    for (std::uint64_t remaining = counted; remaining != 0; remaining &= remaining - 1)
      if (!widen(s, leaf.mValues[64 * x + std::countr_zero(remaining)])) ++s.nan_count;
  }
}

template <class Value>
void add_tile(GridStats& s, const nanovdb::Coord& origin, std::int32_t edge, const Value& value, const MaskView* valid) {
  const std::uint64_t counted = valid ? valid->count(origin, edge) : cube(edge);
  s.active_voxels += counted;
  if (counted > 0 && !widen(s, value)) s.nan_count += counted;
}

/// Calls body(part, begin, end) for ranges of the array in parallel, each with its own `part`, and merges the parts into `all`.
template <class Part, class Merge, class Body>
void in_parts(Part& all, std::size_t count, std::size_t grain_size, const Part& initial, const Merge& merge_parts, const Body& body) {
  std::mutex mutex;
  parallel_for(count, grain_size, [&](std::size_t begin, std::size_t end) {
    Part part = initial;
    body(part, begin, end);
    const std::lock_guard<std::mutex> lock(mutex);
    merge_parts(all, part);
  });
}

void add_leaf_box(ActiveBox& box, const nanovdb::Coord& origin, const nanovdb::Mask<3>& mask) {
  std::uint64_t layers = 0;
  int x0 = 8, x1 = -1;
  for (int x = 0; x < 8; ++x) {
    const auto word = mask.getWord<std::uint64_t>(x);
    if (word == 0) continue;
    layers |= word;
    x0 = std::min(x0, x);
    x1 = x;
  }
  if (layers == 0) return;
  const int y0 = std::countr_zero(layers) / 8, y1 = 7 - std::countl_zero(layers) / 8;
  std::uint64_t row = layers | layers >> 32;
  row |= row >> 16;
  row = (row | row >> 8) & 0xff;
  const int z0 = std::countr_zero(row), z1 = 63 - std::countl_zero(row);
  box.extend(origin.offsetBy(x0, y0, z0), origin.offsetBy(x1, y1, z1));
}

}  // namespace

template <class T>
ActiveBox compute_active_box(const nanovdb::NanoGrid<T>& grid) {
  const NanoNodes<T> nodes = view_nodes(grid);
  ActiveBox box;
  const auto join = [](ActiveBox& all, const ActiveBox& part) {
    if (!part.empty()) all.extend(part.lo, part.hi);
  };
  const auto add = [](ActiveBox& part, const nanovdb::Coord& origin, std::int32_t edge) { part.extend(origin, origin.offsetBy(edge - 1)); };
  in_parts(box, nodes.leaves.size(), 16 * kGrain, ActiveBox{}, join, [&](ActiveBox& part, std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) add_leaf_box(part, nodes.leaves[n].mBBoxMin, nodes.leaves[n].mValueMask);
  });
  for (const auto& lower : nodes.lowers)
    for_active_tiles(lower, [&](const nanovdb::Coord& origin, std::int32_t edge, const auto&) { add(box, origin, edge); });
  for (const auto& upper : nodes.uppers)
    for_active_tiles(upper, [&](const nanovdb::Coord& origin, std::int32_t edge, const auto&) { add(box, origin, edge); });
  for (const auto& entry : nodes.entries)
    if (entry.isActive()) add(box, entry.origin(), kUpperEdge);
  return box;
}

bool is_within_index_limits(const ActiveBox& box) {
  for (int a = 0; a < 3; ++a)
    if (box.lo[a] < -kMaxAbsIndex || box.hi[a] > kMaxAbsIndex) return false;
  return true;
}

template <class T>
NanoStats compute_stats(const nanovdb::NanoGrid<T>& grid, const NanoMask* valid) {
  const NanoNodes<T> nodes = view_nodes(grid);
  GridStats all = empty_stats();
  in_parts(all, nodes.leaves.size(), kGrain, empty_stats(), merge, [&](GridStats& part, std::size_t begin, std::size_t end) {
    std::optional<MaskView> valid_view;
    if (valid) valid_view.emplace(*valid);
    for (std::size_t n = begin; n < end; ++n) add_leaf<T>(part, nodes.leaves[n], valid_view ? &*valid_view : nullptr);
  });
  const auto add_nodes = [&](const auto& array) {
    in_parts(all, array.size(), 1, empty_stats(), merge, [&](GridStats& part, std::size_t begin, std::size_t end) {
      std::optional<MaskView> valid_view;
      if (valid) valid_view.emplace(*valid);
      for (std::size_t n = begin; n < end; ++n)
        for_active_tiles(array[n], [&](const nanovdb::Coord& origin, std::int32_t edge, const auto& value) {
          add_tile(part, origin, edge, value, valid_view ? &*valid_view : nullptr);
        });
    });
  };
  add_nodes(nodes.lowers);
  add_nodes(nodes.uppers);
  std::optional<MaskView> valid_view;
  if (valid) valid_view.emplace(*valid);
  for (const auto& entry : nodes.entries)
    if (entry.isActive()) add_tile(all, entry.origin(), kUpperEdge, entry.value, valid_view ? &*valid_view : nullptr);
  NanoStats result{all, all.min <= all.max};
  finish(result.stats, typename NanoTypes<T>::Value{});
  if (!result.has_range) {
    result.stats.min = result.stats.max = 0;
    result.stats.component_min = result.stats.component_max = Vec3(0.0);
  }
  return result;
}

std::uint64_t count_voxels(const NanoMask& mask) {
  const NanoNodes<nanovdb::ValueMask> nodes = view_nodes(mask);
  std::uint64_t count = 0;
  for (const auto& leaf : nodes.leaves) count += leaf.mValueMask.countOn();
  const auto add = [&](const nanovdb::Coord&, std::int32_t edge, bool) { count += cube(edge); };
  for (const auto& lower : nodes.lowers) for_active_tiles(lower, add);
  for (const auto& upper : nodes.uppers) for_active_tiles(upper, add);
  for (const auto& entry : nodes.entries) count += entry.isActive() ? cube(kUpperEdge) : 0;
  return count;
}

template ActiveBox compute_active_box<float>(const nanovdb::NanoGrid<float>&);
template ActiveBox compute_active_box<nanovdb::Vec3f>(const nanovdb::NanoGrid<nanovdb::Vec3f>&);
template ActiveBox compute_active_box<nanovdb::ValueMask>(const NanoMask&);
template NanoStats compute_stats<float>(const nanovdb::NanoGrid<float>&, const NanoMask*);
template NanoStats compute_stats<nanovdb::Vec3f>(const nanovdb::NanoGrid<nanovdb::Vec3f>&, const NanoMask*);

}  // namespace catena::field
