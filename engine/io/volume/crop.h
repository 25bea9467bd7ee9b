// SPDX-License-Identifier: MIT
/// Crops a grid to the voxels that a world box needs: those in the box's bounding box along the axes of the grid, rounded outward. The
/// cropped grid has a value wherever both the box and the full grid have one, bitwise equal to the full grid's (except in cubic cells near
/// the faces, which need samples from outside). The domain ends with the crop, so that the probe never reaches a voxel that was not loaded;
/// for a .vdb it is the bounding box of the remaining active voxels. Off the haptic thread; any thread.
#pragma once
#include "engine/base/result.h"
#include "engine/field/grid/grid.h"
#include "engine/field/nanovdb/nano_statistics.h"

namespace catena::field {

/// Returns the index range of the voxels that a world box needs; clamped to kMaxAbsIndex, not to a grid.
ActiveBox voxels_in_box(const Box& world, const Mapping& mapping);

/// Crops a grid. Returns an Error that begins with `path` when the box contains no voxels of the grid, or too few along an axis, or the
/// memory budget is too small.
Result<AnyField> crop_field(const std::string& path, const AnyField& field, const Box& world);

}  // namespace catena::field
