// SPDX-License-Identifier: MIT
#include "render/residency/voxel_block.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/threads.h"
#include "engine/field/field_display_range.h"

namespace catena::render {

using field::Index3;

VoxelExtent voxel_extent(const field::ScalarGrid& grid) {
  const Vec3 lo = grid.index_box().lo, hi = grid.index_box().hi;
  const auto whole = [](double v) { return std::int32_t(std::lround(v)); };
  const Index3 first{whole(lo.x), whole(lo.y), whole(lo.z)};
  return {first, {whole(hi.x) - first.x + 1, whole(hi.y) - first.y + 1, whole(hi.z) - first.z + 1}};
}

bool has_invalid_cells(const field::ScalarGrid& grid) {
  return grid.has_mask() || grid.stats().nan_count > 0 || !std::isfinite(grid.background());
}

void VoxelBlock::read(const field::ScalarGrid& grid, const Index3& origin, const Index3& box, bool masked) {
  size = box;
  values.resize(std::size_t(box.x) * std::size_t(box.y) * std::size_t(box.z));
  grid.read_block(origin, box, values);
  used.clear();
  if (!masked) return;
  for (float& v : values) v = std::isfinite(v) ? v : 0;
  // all cells that have a voxel of the box as a corner
  const Index3 cells{box.x + 1, box.y + 1, box.z + 1};
  std::vector<std::uint8_t> valid(std::size_t(cells.x) * std::size_t(cells.y) * std::size_t(cells.z));
  grid.read_cell_validity({origin.x - 1, origin.y - 1, origin.z - 1}, cells, valid);
  used.resize(values.size());
  const std::size_t row = std::size_t(cells.x), plane = row * std::size_t(cells.y);
  std::size_t i = 0;
  for (int z = 0; z < box.z; ++z)
    for (int y = 0; y < box.y; ++y)
      for (int x = 0; x < box.x; ++x, ++i) {
        const std::uint8_t* c = &valid[std::size_t(z) * plane + std::size_t(y) * row + std::size_t(x)];
        used[i] = c[0] | c[1] | c[row] | c[row + 1] | c[plane] | c[plane + 1] | c[plane + row] | c[plane + row + 1];
      }
}

std::vector<float> sample_values(const field::ScalarGrid& grid) {
  constexpr int kBlocks = 64;
  const VoxelExtent extent = voxel_extent(grid);
  const auto blocks = [](int n) { return (n + 7) / 8; };
  const double all = double(blocks(extent.size.x)) * blocks(extent.size.y) * blocks(extent.size.z);
  const int stride = 8 * std::max(1, int(std::ceil(std::cbrt(all / kBlocks))));
  const bool masked = has_invalid_cells(grid);
  std::vector<float> values;
  VoxelBlock block;
  for (int z = 0; z < extent.size.z; z += stride)
    for (int y = 0; y < extent.size.y; y += stride)
      for (int x = 0; x < extent.size.x; x += stride) {
        const Index3 size{std::min(8, extent.size.x - x), std::min(8, extent.size.y - y), std::min(8, extent.size.z - z)};
        block.read(grid, {extent.lo.x + x, extent.lo.y + y, extent.lo.z + z}, size, masked);
        for (std::size_t i = 0; i < block.values.size(); ++i)
          if (block.is_used(i)) values.push_back(block.values[i]);
      }
  return values;
}

void for_each_slab(const field::ScalarGrid& grid, const SlabRange& slabs, const std::function<void(const Slab&)>& body) {
  const VoxelExtent extent = voxel_extent(grid);
  const Index3 n = extent.size;
  const bool masked = has_invalid_cells(grid);
  parallel_for(std::size_t((slabs.count + kSlabPlanes - 1) / kSlabPlanes), 1, [&](std::size_t begin, std::size_t end) {
    VoxelBlock block;
    for (std::size_t k = begin; k < end; ++k) {
      const int first = slabs.first + kSlabPlanes * int(k), planes = std::min(kSlabPlanes, slabs.first + slabs.count - first);
      const int from = std::max(0, first - slabs.margin_before), to = std::min(n.z, first + planes + slabs.margin_after);
      block.read(grid, {extent.lo.x, extent.lo.y, extent.lo.z + from}, {n.x, n.y, to - from}, masked);
      body({first, planes, first - from, block});
    }
  });
}

void widen_to_cells(ValueInterval& range, const VoxelBlock& block, const ValueInterval& active) {
  const auto from = float(active.min), to = float(active.max);
  auto min_value = float(range.min), max_value = float(range.max);
  const int cells = block.size.x - 1;
  const std::size_t row = std::size_t(block.size.x), plane = row * std::size_t(block.size.y);
  // minimum and maximum of the four corners in the plane x
  std::vector<float> low(row), high(row);
  for (int z = 0; z + 1 < block.size.z; ++z)
    for (int y = 0; y + 1 < block.size.y; ++y) {
      const std::size_t first = block.voxel_index(0, y, z);
      const float *a = &block.values[first], *b = a + row, *c = a + plane, *d = c + row;
      for (std::size_t x = 0; x < row; ++x) {
        const float l0 = a[x] < b[x] ? a[x] : b[x], l1 = c[x] < d[x] ? c[x] : d[x], g0 = a[x] < b[x] ? b[x] : a[x],
                    g1 = c[x] < d[x] ? d[x] : c[x];
        low[x] = l0 < l1 ? l0 : l1;
        high[x] = g0 < g1 ? g1 : g0;
      }
      for (int x = 0; x < cells; ++x) {
        const float l = low[x] < low[x + 1] ? low[x] : low[x + 1], g = high[x] < high[x + 1] ? high[x + 1] : high[x];
        bool touches = g > from && l < to && (l < min_value || g > max_value);
        if (touches && !block.used.empty()) {
          const std::uint8_t* u = &block.used[first + std::size_t(x)];
          touches = u[0] && u[1] && u[row] && u[row + 1] && u[plane] && u[plane + 1] && u[plane + row] && u[plane + row + 1];
        }
        min_value = touches && l < min_value ? l : min_value;
        max_value = touches && g > max_value ? g : max_value;
      }
    }
  range.min = std::min(range.min, double(min_value));
  range.max = std::max(range.max, double(max_value));
}

CodeScale::CodeScale(const ValueInterval& range, bool is_masked, int bits) : has_mask(is_masked), max_code((1 << bits) - 1) {
  per_code = (range.max - range.min) / (max_code - min_code());
  if (!(per_code > 0) || !std::isfinite(1 / per_code)) per_code = 0;
  lo = range.min - min_code() * per_code;
}

CodeRange CodeScale::range_of(int min, int max, bool has_unused) const {
  constexpr int kLast = 255;
  if (max_code <= kLast) return {std::uint8_t(min), std::uint8_t(max), has_unused};
  const auto unit = [&](int code) { return code < range_lo ? 0 : (code - range_lo) / range_step; };
  return {std::uint8_t(std::min(unit(min), kLast - 1)), std::uint8_t(std::min(unit(max) + 1, kLast)), has_unused};
}

double CodeScale::lower_end(int unit) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return unit == 0 ? -kInfinity : unit == 255 ? kInfinity : range_lo + double(unit) * range_step;
}

ValueInterval clip_outliers(ValueInterval range, const field::ScalarGrid& grid, const ValueInterval& active) {
  const DisplayRange& shown = display_range(grid);
  if (shown.below.count > 0) range.min = std::max(range.min, std::min(active.min, shown.lo));
  if (shown.above.count > 0) range.max = std::min(range.max, std::max(active.max, shown.hi));
  return range;
}

void CodeScale::encode(const VoxelBlock& block, std::size_t first, std::size_t count, std::uint8_t* out) const {
  const auto encode_value = encoder();
  const float* values = &block.values[first];
  for (std::size_t i = 0; i < count; ++i) out[i] = encode_value(values[i]);
  if (block.used.empty()) return;
  for (std::size_t i = 0; i < count; ++i)
    if (!block.used[first + i]) out[i] = kInvalidCode;
}

std::uint16_t CodeAppearance::classify(const CodeRange& range) const {
  if (range.empty()) return 1;
  if (appearance_id[range.min] != appearance_id[range.max]) return 0;
  if (is_invisible[range.min]) return 1;
  return range.has_unused ? std::uint16_t(0) : std::uint16_t(2 + appearance_id[range.min]);
}

}  // namespace catena::render
