/// A part of a grid, in the place of the whole: the voxels that a box in the world needs. They are those in its bounding box along the
/// grid's axes, rounded outwards, so that the part has a value wherever the box and the whole have one; there it is the whole's, to the bit
/// (cubic cells near its faces excepted: they take samples from beyond). The domain ends with the part, so that the hand never meets a
/// voxel that was not read; that of a .vdb is the box about the active voxels that are left, as always. Off the tick, any thread.
#pragma once
#include "engine/base/result.h"
#include "engine/field/grid/grid.h"
#include "engine/field/nanovdb/nano_statistics.h"

namespace catena::field {

/// As far as indices reach.
ActiveBox voxels_in_box(const Box& world, const Mapping& mapping);

/// `path` begins the errors: the box has no voxels of the grid, or too few along an axis; the memory does not suffice.
Result<AnyField> crop_field(const std::string& path, const AnyField& field, const Box& world);

}  // namespace catena::field
