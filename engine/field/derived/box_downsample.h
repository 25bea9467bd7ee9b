/// A scalar grid at a whole part of its resolution, for where the whole does not fit.
///   coarse voxel c is the box average of the fine voxels factor c .. factor c + factor - 1 of each axis, and lies at their middle:
///   fine index = factor c + (factor - 1) / 2
/// Outliers its faces the fine grid is continued by odd reflection, v(lo - k) = 2 v(lo) - v(lo + k), so that the coarse grid reaches over
/// the whole fine domain and a linear field stays what it is. Only voxels of valid cells are averaged; next to others the
/// reflection is not odd but plain; where there is none the coarse voxel is NaN, and its cells are invalid. Where the mask is one of cells
/// a coarse cell is invalid when half of the fine cells in it, or more, are. Of a grid whose nearest voxel counts (Interpolation) a coarse
/// voxel is one of the fine voxels there: no value is invented. Blocks that hold one value stay as they are: a sparse grid stays sparse.
#pragma once
#include "engine/base/result.h"
#include "engine/field/grid/grid.h"

namespace catena::field {

/// What coarsen() gives.
struct CoarseGrid {
  std::shared_ptr<const ScalarGrid> grid;  ///< the coarse grid; its own mapping and version
  Box domain;  ///< of the fine grid, in the coarse one's index space: within its index box, less than a voxel smaller at each face
};

/// `factor` 2, 4 or 8. An error only where no voxel can be averaged.
Result<CoarseGrid> box_downsample(const ScalarGrid& grid, int factor);

}  // namespace catena::field
