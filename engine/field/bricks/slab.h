// SPDX-License-Identifier: MIT
/// Part of a paged grid around a plane, as a grid of its own, for slices: two layers of nodes, the plane between them.
///   parallel to two axes of the voxels   the voxels of the finest level on both sides of the plane: values in it are exact
///   any other plane                      values of the finest level, spaced half a voxel edge apart, or one if memory is short
/// If that has too many nodes, the finest coarser level that has few enough. Any thread.
#pragma once
#include <functional>
#include <memory>

#include "engine/field/bricks/paged_grid.h"

namespace catena::field {

/// Most nodes of a slab.
inline constexpr double kMaxSlabNodes = 1 << 23;

/// Makes the slab of a plane through `point`. Blocks while bricks are read; ends early with null when `is_cancelled` returns true, or if
/// the plane does not meet the grid. The Error is a complete message.
Result<std::shared_ptr<const ScalarGrid>> make_slab(const PagedGrid& grid, const Vec3& point, const Vec3& normal,
                                                    const std::function<bool()>& is_cancelled);

}  // namespace catena::field
