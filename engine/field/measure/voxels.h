// SPDX-License-Identifier: MIT
/// Voxels of a grid that a measurement counts: active, valid where the grid has a mask, and finite. Statistics of a set of them.
/// Not for the haptic tick; any thread.
#pragma once
#include <algorithm>
#include <cstdint>

#include "engine/base/export.h"
#include "engine/base/result.h"
#include "engine/field/grid/grid.h"
#include "engine/field/measure/moments.h"

namespace catena::field {

/// Largest box of voxels that is measured.
inline constexpr double kMaxMeasuredVoxels = 0x1p34;

/// Index box of a grid.
struct VoxelBox {
  Index3 lo, size;  ///< first voxel, and number of voxels per axis
  /// Number of voxels.
  std::uint64_t voxels() const { return static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y) * size.z; }
};
/// Returns the box of voxels. Error (a message fragment): it has more than kMaxMeasuredVoxels, or there is no memory for its slabs.
CATENA_EXPORT Result<VoxelBox> measurable_box(const ScalarGrid& grid);

/// Numbers of voxels that a measurement leaves out.
struct LeftOut {
  std::uint64_t masked = 0;      ///< voxels of the box that are inactive or invalid
  std::uint64_t not_finite = 0;  ///< voxels that are NaN or infinite
};
/// Returns the numbers for a grid and its box.
CATENA_EXPORT LeftOut left_out(const ScalarGrid& grid, const VoxelBox& box);

/// Returns true when the voxels of two grids coincide: same box, and positions equal within 1e-4 of a voxel.
CATENA_EXPORT bool is_same_lattice(const Field& a, const Field& b);

/// What is measured of a label or a connected part.
struct CATENA_EXPORT RegionStats {
  std::uint64_t voxels = 0;  ///< number of voxels
  Moments values;            ///< of the second field, over those of the voxels at which it has a value
  Vec3 index_sum{0.0};       ///< sum of the voxels' indices
  Index3 lo, hi;             ///< bounding box in index space, both ends included

  /// Adds the voxels first..last of the row (y, z).
  void add_run(std::int32_t first, std::int32_t last, std::int32_t y, std::int32_t z);
  /// Adds the voxels of another region.
  void merge(const RegionStats& other);
  /// Position of the mean of the voxel centers, world.
  Vec3 centroid(const Mapping& mapping) const { return mapping.world_from_index(index_sum / static_cast<double>(voxels)); }
};

/// Volume of one voxel, cubed world units.
CATENA_EXPORT double voxel_volume(const Mapping& mapping);

}  // namespace catena::field
