// SPDX-License-Identifier: MIT
/// A volume at half the resolution, computed while it is read: the first level that a store lacks. Any thread.
#pragma once
#include <functional>

#include "engine/field/bricks/brick_source.h"
#include "engine/io/volume/voxel_source.h"

namespace catena::field {

/// Called with the range of each brick of the full resolution that has been read, from any thread. An Error ends the reading.
using UseRange = std::function<Outcome(const Index3& brick, const BrickRange& range)>;

/// Makes the source of a volume at half the resolution, with the values of halve_brick() (engine/io/zarr/brick_values.h). Boxes that are
/// read from it must begin at multiples of kBrickEdge. Bricks without data are not read. `chunk`: voxels of the volume that are stored
/// together. `max_bytes`: memory of the voxels that are best read at once. The position is not that of the volume: the mapping is the
/// identity.
VoxelSource halve_voxels(VoxelSource full, const Index3& chunk, double max_bytes, UseRange use_range);

}  // namespace catena::field
