/// A grid of numbers that a program has in memory, in whatever form: it is asked for them layer by layer, so that beside the program's own
/// numbers stands only the grid that is made of them.
#pragma once
#include <functional>
#include <span>
#include <string>

#include "engine/base/result.h"
#include "engine/field/field.h"

namespace catena::field {

/// How a program hands its numbers over.
struct SliceSource {
  Index3 size{0, 0, 0};    ///< voxels along x, y, z; at least 2 each
  bool is_vector = false;  ///< three numbers a voxel
  /// Writes the layers z, z + 1, ... that fill `out`: x fastest, then y, then z; vectors as three numbers a voxel. Called with z rising.
  std::function<void(int z, std::span<float> out)> read;
};

/// Voxel (i, j, k) lies at mapping.world_from_index of it. Values that are not finite are kept: cells that touch them are not inside. An
/// error (one phrase) where an axis has fewer than two voxels, no value is finite, or the grid does not fit into the memory that is
/// allowed.
Result<AnyField> make_grid_from_slices(std::string name, const Mapping& mapping, const SliceSource& layers);

}  // namespace catena::field
