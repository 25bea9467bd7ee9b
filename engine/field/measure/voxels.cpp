// SPDX-License-Identifier: MIT
#include "engine/field/measure/voxels.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/matrix.hpp>
#include <limits>
#include <optional>

#include "engine/base/memory_limit.h"
#include "engine/field/grid/grid_storage.h"
#include "engine/field/nanovdb/nano_nodes.h"

namespace catena::field {
namespace {

/// Tolerance of voxel positions, in voxels.
constexpr double kSameVoxel = 1e-4;

Index3 rounded(const Vec3& v) {
  return {static_cast<std::int32_t>(std::lround(v.x)), static_cast<std::int32_t>(std::lround(v.y)),
          static_cast<std::int32_t>(std::lround(v.z))};
}

}  // namespace

Result<VoxelBox> measurable_box(const ScalarGrid& grid) {
  const Index3 lo = rounded(grid.index_box().lo), hi = rounded(grid.index_box().hi);
  const VoxelBox box{lo, {hi.x - lo.x + 1, hi.y - lo.y + 1, hi.z - lo.z + 1}};
  const double slice = static_cast<double>(box.size.x) * box.size.y;
  if (slice * box.size.z > kMaxMeasuredVoxels)
    return Error{fmt::format("the box of the grid has {:.4g} voxels, expected at most {:.4g}", slice * box.size.z, kMaxMeasuredVoxels)};
  constexpr double kBytes = kSlabLayers * (sizeof(float) + sizeof(double) + 1);
  CATENA_CHECK(check_memory_available("the measurement", slice * kBytes * std::max(1u, std::thread::hardware_concurrency())));
  return box;
}

LeftOut left_out(const ScalarGrid& grid, const VoxelBox& box) {
  return {box.voxels() - grid.stats().active_voxels, grid.stats().nan_count};
}

void read_counted(const ScalarGrid& grid, const Index3& origin, const Index3& size, std::span<const float> values,
                  std::span<std::uint8_t> counted) {
  const ScalarGrid::Storage& storage = grid.storage();
  std::optional<MaskView> valid;
  if (storage.valid_voxels) valid.emplace(*storage.valid_voxels);
  for_blocks(*storage.values, origin, size, [&](auto& accessor, const nanovdb::Coord& block, const Index3& first, const Index3& after) {
    const auto* leaf = accessor.probeLeaf(block);
    const std::uint64_t tile = leaf == nullptr && accessor.isActive(block) ? ~std::uint64_t{0} : 0;
    std::uint64_t words[8];
    for (int x = 0; x < 8; ++x) {
      words[x] = leaf ? leaf->valueMask().template getWord<std::uint64_t>(x) : tile;
      if (valid) words[x] &= valid->word(block, x);
    }
    for (std::int32_t z = first.z; z < after.z; ++z)
      for (std::int32_t y = first.y; y < after.y; ++y) {
        const std::size_t row = (static_cast<std::size_t>(z - origin.z) * size.y + (y - origin.y)) * size.x;
        for (std::int32_t x = first.x; x < after.x; ++x) {
          const std::size_t at = row + static_cast<std::size_t>(x - origin.x);
          counted[at] = (words[x & 7] >> (8 * (y & 7) + (z & 7)) & 1) != 0 && std::isfinite(values[at]) ? 1 : 0;
        }
      }
  });
}

bool is_same_lattice(const Field& a, const Field& b) {
  if (!(a.index_box() == b.index_box())) return false;
  for (int i = 0; i < 8; ++i) {
    const Vec3 difference = a.mapping().index_from_world_linear * (a.corner(i) - b.corner(i));
    if (!(max_abs(difference) <= kSameVoxel)) return false;
  }
  return true;
}

VoxelSlab SlabReader::read(int z, int layers) const {
  VoxelSlab slab{{box_.lo.x, box_.lo.y, box_.lo.z + z}, {box_.size.x, box_.size.y, layers}, {}, {}, {}};
  const std::size_t count = static_cast<std::size_t>(slab.size.x) * slab.size.y * layers;
  slab.voxels.resize(count);
  slab.counted.resize(count);
  grid_.read_block(slab.origin, slab.size, slab.voxels);
  read_counted(grid_, slab.origin, slab.size, slab.voxels, slab.counted);
  if (values_ == nullptr) return slab;
  slab.values.assign(count, std::numeric_limits<double>::quiet_NaN());
  if (same_) {
    std::vector<float> values(count);
    std::vector<std::uint8_t> valid(count);
    values_->grid()->read_block(slab.origin, slab.size, values);
    read_counted(*values_->grid(), slab.origin, slab.size, values, valid);
    for (std::size_t i = 0; i < count; ++i)
      if (valid[i] != 0) slab.values[i] = values[i];
    return slab;
  }
  Cursor cursor;
  std::size_t at = 0;
  for (int k = 0; k < layers; ++k)
    for (int j = 0; j < slab.size.y; ++j)
      for (int i = 0; i < slab.size.x; ++i, ++at) {
        if (slab.counted[at] == 0) continue;
        const Vec3 index(slab.origin.x + i, slab.origin.y + j, slab.origin.z + k);
        const ScalarSample sample = values_->sample(grid_.mapping().world_from_index(index), cursor);
        if (sample.inside && std::isfinite(sample.value)) slab.values[at] = sample.value;
      }
  return slab;
}

void RegionStats::add_run(std::int32_t first, std::int32_t last, std::int32_t y, std::int32_t z) {
  if (voxels == 0) lo = {first, y, z}, hi = {last, y, z};
  const double n = static_cast<double>(last) - first + 1;
  voxels += static_cast<std::uint64_t>(n);
  index_sum += Vec3(n * (static_cast<double>(first) + last) / 2, n * y, n * z);
  lo = {std::min(lo.x, first), std::min(lo.y, y), std::min(lo.z, z)};
  hi = {std::max(hi.x, last), std::max(hi.y, y), std::max(hi.z, z)};
}

void RegionStats::merge(const RegionStats& other) {
  if (other.voxels == 0) return;
  if (voxels == 0) {
    *this = other;
    return;
  }
  voxels += other.voxels;
  values.merge(other.values);
  index_sum += other.index_sum;
  lo = {std::min(lo.x, other.lo.x), std::min(lo.y, other.lo.y), std::min(lo.z, other.lo.z)};
  hi = {std::max(hi.x, other.hi.x), std::max(hi.y, other.hi.y), std::max(hi.z, other.hi.z)};
}

double voxel_volume(const Mapping& mapping) { return std::fabs(glm::determinant(mapping.world_from_index_linear)); }

}  // namespace catena::field
