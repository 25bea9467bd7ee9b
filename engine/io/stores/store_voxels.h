// SPDX-License-Identifier: MIT
/// A grid of a store as a source of voxels. Private to this module.
#pragma once
#include <memory>
#include <string>

#include "engine/io/stores/store.h"
#include "engine/io/volume/voxel_source.h"

namespace catena::field {

/// Opens the finest level of the grid and time step that a request names, in its stored type. A VolumeReader::open_voxels.
Result<VoxelSource> open_stored_voxels(const LoadRequest& request);

/// Makes the source of a level of a grid at a time step; all of them exist.
VoxelSource voxels_of_level(const std::shared_ptr<Store>& store, int grid, int level, int step);

/// Returns the path of a store without slashes at its end.
std::string path_of_store(const Store& store);

/// Returns a text that differs if the voxels of a grid at a time step may differ: paths, sizes and times of the files.
std::string identify_stored_grid(const Store& store, int grid, int step);

/// Returns how many bricks along each axis are best read at once: those that share chunks, within `max_bytes`.
Index3 bricks_that_share_chunks(const Index3& size, const Index3& chunk, std::size_t voxel_bytes, double max_bytes);

}  // namespace catena::field
