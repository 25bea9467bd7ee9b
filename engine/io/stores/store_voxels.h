// SPDX-License-Identifier: MIT
/// A grid of a store as a source of voxels. Private to this folder.
#pragma once
#include "engine/io/volume/voxel_source.h"

namespace catena::field {

/// Opens the finest level of the grid and time step that a request names, in its stored type. A VolumeReader::open_voxels.
Result<VoxelSource> open_stored_voxels(const LoadRequest& request);

/// Returns how many bricks along each axis are best read at once: those that share chunks, within `max_bytes`.
Index3 bricks_that_share_chunks(const Index3& size, const Index3& chunk, std::size_t voxel_bytes, double max_bytes);

}  // namespace catena::field
