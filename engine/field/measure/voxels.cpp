// SPDX-License-Identifier: MIT
#include "engine/field/measure/voxels.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/matrix.hpp>

#include "engine/base/memory_limit.h"
#include "engine/field/measure/slabs.h"

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

bool is_same_lattice(const Field& a, const Field& b) {
  if (!(a.index_box() == b.index_box())) return false;
  for (int i = 0; i < 8; ++i) {
    const Vec3 difference = a.mapping().index_from_world_linear * (a.corner(i) - b.corner(i));
    if (!(max_abs(difference) <= kSameVoxel)) return false;
  }
  return true;
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
