// SPDX-License-Identifier: MIT
/// Downsampling of a scalar grid by an integer factor, for uses where the full resolution does not fit into memory.
///   Coarse voxel c is the box average of the fine voxels factor c .. factor c + factor - 1 along each axis and lies at their center:
///   fine index = factor c + (factor - 1) / 2
/// Beyond its faces the fine grid is extended by odd reflection, v(lo - k) = 2 v(lo) - v(lo + k), so the coarse grid covers the whole fine
/// domain and a linear field stays exact. Only voxels of valid cells are averaged. Next to invalid voxels plain (even) reflection is used;
/// where no voxel can be averaged the coarse voxel is NaN and its cells are invalid. When the grid has a mask of cells, a coarse cell is
/// invalid if at least half of the fine cells in it are. For a grid with nearest interpolation a coarse voxel is one of the fine voxels in
/// it, so no new values appear. Blocks of a single value are preserved: a sparse grid stays sparse.
#pragma once
#include "engine/base/export.h"
#include "engine/base/result.h"
#include "engine/field/grid/grid.h"

namespace catena::field {

/// Result of box_downsample().
struct CoarseGrid {
  std::shared_ptr<const ScalarGrid> grid;  ///< coarse grid with its own mapping and version
  /// Domain of the fine grid in index space of the coarse grid: inside its index box, less than one voxel smaller at each face.
  Box domain;
};

/// Downsamples a grid; `factor`: 2, 4 or 8. Error: no voxel can be averaged, the grid has too many blocks, or the memory
/// budget is exceeded.
CATENA_EXPORT Result<CoarseGrid> box_downsample(const ScalarGrid& grid, int factor);

}  // namespace catena::field
