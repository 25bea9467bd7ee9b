// SPDX-License-Identifier: MIT
/// Grid from numbers that the application has in memory, in any form. The application is called for them slice by slice, so only the grid
/// itself is allocated in addition.
#pragma once
#include <functional>
#include <span>
#include <string>

#include "engine/base/export.h"
#include "engine/base/result.h"
#include "engine/field/field.h"

namespace catena::field {

/// Source of the values of a grid.
struct CATENA_EXPORT SliceSource {
  Index3 size{0, 0, 0};    ///< number of voxels along x, y, z; at least 2 each
  bool is_vector = false;  ///< three numbers per voxel
  /// Writes the slices z, z + 1, ... that fill `out`: x fastest, then y, then z; vectors as three numbers per voxel. Called with ascending
  /// z.
  std::function<void(int z, std::span<float> out)> read;
};

/// Makes a grid; voxel (i, j, k) is at mapping.world_from_index of its index. Values that are not finite are stored; the cells that touch
/// them are invalid. Error: an axis has fewer than two voxels or too many, the mapping cannot be inverted, no value is finite, or the
/// memory budget is exceeded.
CATENA_EXPORT Result<AnyField> make_grid_from_slices(std::string name, const Mapping& mapping, const SliceSource& layers);

}  // namespace catena::field
