// SPDX-License-Identifier: MIT
/// Levels and metadata of an OME-Zarr 0.4 image. Any thread.
#pragma once
#include <string>
#include <vector>

#include "engine/field/bricks/brick_source.h"
#include "engine/io/volume/voxel_source.h"

namespace catena::field {

/// Returns the levels of an image, each of half the resolution of the one before, up to the first that is one brick. An axis of one voxel
/// is not halved. Voxel centers of a level are at the means of the voxels of level 0 that they cover.
std::vector<BrickLevel> halved_levels(const Index3& size, const Mapping& mapping);

/// Returns the fill value of the store: that of the source, or 0 where JSON or a mean would change it.
double stored_fill_value(const VoxelSource& source);

/// Returns the text of `.zarray` of a level.
std::string zarray_text(const VoxelSource& source, const BrickLevel& level);
/// Returns the text of `.zattrs` of the image. `range`: of all finite values, for the window; min > max: no window.
std::string zattrs_text(const VoxelSource& source, const std::vector<BrickLevel>& levels, const BrickRange& range);

}  // namespace catena::field
