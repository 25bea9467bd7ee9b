// SPDX-License-Identifier: MIT
#include "engine/field/field_display_range.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <mutex>
#include <optional>

#include "engine/base/threads.h"
#include "engine/field/grid/grid_storage.h"
#include "engine/field/nanovdb/nano_nodes.h"

namespace catena::field {
namespace {

constexpr std::size_t kSampledBlocks = 256, kRangeGrain = 64, kMaxTiles = 4096, kVoxelsOfLeaf = 512;

float size_of(float value) { return value; }
float size_of(const nanovdb::Vec3f& v) { return static_cast<float>(norm(Vec3(v[0], v[1], v[2]))); }

/// Calls visit(value, voxels) for active, valid voxels with a finite value: for those of every `step`-th leaf, and once for each tile.
template <class T, class Visit>
void values_of_leaves(const NanoNodes<T>& nodes, const NanoMask* mask, std::size_t begin, std::size_t end, std::size_t step,
                      const Visit& visit) {
  std::optional<MaskView> valid;
  if (mask) valid.emplace(*mask);
  for (std::size_t n = begin; n < end; n += step) {
    const auto& leaf = nodes.leaves[n];
    for (int x = 0; x < 8; ++x) {
      std::uint64_t on = leaf.mValueMask.template getWord<std::uint64_t>(x);
      if (valid) on &= valid->word(leaf.mBBoxMin, x);
      for (; on != 0; on &= on - 1) {
        const float value = size_of(leaf.mValues[64 * x + std::countr_zero(on)]);
        if (std::isfinite(value)) visit(value, std::uint64_t{1});
      }
    }
  }
}

template <class T, class Visit>
void values_of_tiles(const NanoNodes<T>& nodes, const NanoMask* mask, const Visit& visit) {
  std::optional<MaskView> valid;
  if (mask) valid.emplace(*mask);
  const auto tile = [&](const nanovdb::Coord& origin, std::int32_t edge, const auto& stored) {
    const float value = size_of(stored);
    const auto width = static_cast<std::uint64_t>(edge);
    const std::uint64_t count = valid ? valid->count(origin, edge) : width * width * width;
    if (std::isfinite(value) && count > 0) visit(value, count);
  };
  for (const auto& lower : nodes.lowers) for_active_tiles(lower, tile);
  for (const auto& upper : nodes.uppers) for_active_tiles(upper, tile);
  for (const auto& entry : nodes.entries)
    if (entry.isActive()) tile(entry.origin(), kUpperEdge, entry.value);
}

}  // namespace

template <class T>
DisplayRange compute_display_range(const nanovdb::NanoGrid<T>& grid, const NanoMask* mask, const GridStats& stats) {
  const NanoNodes<T> nodes = view_nodes(grid);
  std::vector<float> sample;
  const std::size_t step = 1 + nodes.leaves.size() / kSampledBlocks;
  values_of_leaves(nodes, mask, 0, nodes.leaves.size(), step, [&](float v, std::uint64_t) { sample.push_back(v); });
  const std::size_t copies = std::max<std::size_t>(1, kVoxelsOfLeaf / step);
  std::size_t tiles = 0;
  values_of_tiles(nodes, mask, [&](float v, std::uint64_t) {
    if (++tiles <= kMaxTiles) sample.insert(sample.end(), copies, v);
  });
  DisplayRange estimate = catena::display_range(std::move(sample), stats.min, stats.max);
  if (!estimate.has_outliers()) {
    estimate.count = stats.active_voxels - stats.nan_count;
    return estimate;
  }
  const RangeCounter none(estimate);
  RangeCounter all = none;
  std::mutex mutex;
  parallel_for(nodes.leaves.size(), kRangeGrain, [&](std::size_t begin, std::size_t end) {
    RangeCounter part = none;
    values_of_leaves(nodes, mask, begin, end, 1, [&](float v, std::uint64_t count) { part.add(v, count); });
    const std::lock_guard lock(mutex);
    all.merge(part);
  });
  values_of_tiles(nodes, mask, [&](float v, std::uint64_t count) { all.add(v, count); });
  return all.range();
}

template DisplayRange compute_display_range<float>(const nanovdb::NanoGrid<float>&, const NanoMask*, const GridStats&);
template DisplayRange compute_display_range<nanovdb::Vec3f>(const nanovdb::NanoGrid<nanovdb::Vec3f>&, const NanoMask*, const GridStats&);

namespace {

template <class Grid>
const DisplayRange& cached_range(const Grid& grid) {
  const auto& storage = grid.storage();
  {
    const std::lock_guard lock(storage.range_mutex);
    if (storage.cached_range) return *storage.cached_range;
  }
  // computed without the lock: parallel_for() may run other tasks meanwhile, and those may need the lock
  const DisplayRange found =
      storage.data_range ? *storage.data_range : compute_display_range(*storage.values, storage.valid_voxels, grid.stats());
  const std::lock_guard lock(storage.range_mutex);
  if (!storage.cached_range) storage.cached_range = found;
  return *storage.cached_range;
}

}  // namespace

const DisplayRange& display_range(const ScalarGrid& grid) { return cached_range(grid); }
const DisplayRange& display_range(const VectorGrid& grid) { return cached_range(grid); }

DisplayRange display_range(const ScalarField& field) {
  if (field.grid() != nullptr) return display_range(*field.grid());
  return {field.min_value(), field.max_value(), field.min_value(), field.max_value(), 0, {}, {}};
}

DisplayRange display_range(const AnyField& field) {
  if (field.scalar) return display_range(*field.scalar);
  return field.vector && field.vector->grid() != nullptr ? display_range(*field.vector->grid()) : DisplayRange{};
}

DisplayRange display_range(std::span<const double> values, const AnyField& of) {
  if (of.get() == nullptr) return catena::display_range(values);
  const DisplayRange field = display_range(of);
  std::vector<double> displayed;
  for (const double v : values)
    if (std::isfinite(v) && (field.below.count == 0 || v >= field.lo) && (field.above.count == 0 || v <= field.hi)) displayed.push_back(v);
  if (displayed.empty()) return field.has_outliers() ? field : DisplayRange{};
  const auto [lo, hi] = std::ranges::minmax(displayed);
  return {lo, hi, field.data_min, field.data_max, displayed.size(), field.below, field.above};
}

void for_sampled_blocks(const Box& box, std::size_t max_samples, const BlockVisitor& visit) {
  const Index3 lo{static_cast<int>(box.lo.x), static_cast<int>(box.lo.y), static_cast<int>(box.lo.z)};
  const Index3 size{static_cast<int>(box.hi.x - box.lo.x) + 1, static_cast<int>(box.hi.y - box.lo.y) + 1,
                    static_cast<int>(box.hi.z - box.lo.z) + 1};
  const double voxels = static_cast<double>(size.x) * size.y * size.z;
  const int stride = std::max(1, static_cast<int>(std::ceil(std::cbrt(voxels / static_cast<double>(max_samples)))));

  for (int z = 0; z < size.z; z += 8 * stride)
    for (int y = 0; y < size.y; y += 8 * stride)
      for (int x = 0; x < size.x; x += 8 * stride) {
        const Index3 origin{lo.x + x, lo.y + y, lo.z + z};
        const Index3 extent{std::min(8, size.x - x), std::min(8, size.y - y), std::min(8, size.z - z)};
        visit(origin, extent, static_cast<std::size_t>(extent.x * extent.y * extent.z));
      }
}

std::vector<float> sample_values(const ScalarGrid& grid, std::size_t max_samples) {
  std::vector<float> values, block;
  std::vector<std::uint8_t> valid;
  for_sampled_blocks(grid.index_box(), max_samples, [&](const Index3& origin, const Index3& extent, std::size_t count) {
    block.resize(count);
    valid.assign(count, 1);
    grid.read_block(origin, extent, block);
    if (grid.has_mask()) grid.read_cell_validity(origin, extent, valid);
    for (std::size_t i = 0; i < count; ++i)
      if (valid[i] != 0 && std::isfinite(block[i])) values.push_back(block[i]);
  });
  return values;
}

std::vector<float> sample_magnitudes(const VectorGrid& grid, std::size_t max_samples) {
  std::vector<float> values, block;
  Cursor cursor;
  for_sampled_blocks(grid.index_box(), max_samples, [&](const Index3& origin, const Index3& extent, std::size_t count) {
    block.resize(3 * count);
    grid.read_block(origin, extent, block);
    for (std::size_t i = 0; i < count; ++i) {
      const int n = static_cast<int>(i);
      const Index3 at{origin.x + n % extent.x, origin.y + n / extent.x % extent.y, origin.z + n / (extent.x * extent.y)};
      if (grid.has_mask() && !grid.cell(at, cursor).valid) continue;
      const float length = std::hypot(block[3 * i], block[3 * i + 1], block[3 * i + 2]);
      if (std::isfinite(length)) values.push_back(length);
    }
  });
  return values;
}

}  // namespace catena::field
