// SPDX-License-Identifier: MIT
/// Voxels of a box of a scalar grid and the validity of its cells, for one brick of a resident grid. (voxel_block.h is the counterpart for
/// 8-bit codes: validity by voxel.) One object per thread.
#pragma once
#include <cstdint>
#include <vector>

#include "render/residency/resident_grid.h"

namespace catena::render {

/// Voxel values and cell validity of a box.
struct CellBlock {
  field::Index3 voxels;  ///< size in voxels, including the border
  std::vector<float> values;
  std::vector<std::uint8_t> valid;  ///< per voxel of the block (the cell based there); empty: all valid

  /// Reads the voxels from `origin` on. `masked`: some cells may be invalid.
  void read(const field::ScalarGrid& grid, const field::Index3& origin, const field::Index3& size, bool masked);
  std::size_t voxel_index(int x, int y, int z) const { return (std::size_t(z) * voxels.y + y) * voxels.x + x; }
  /// Returns the range over the corners of valid cells with base from `first` to before `end`, and over the voxels within `margin` of the
  /// corners.
  BrickRange compute_range(const field::Index3& first, const field::Index3& end, int margin) const;
};

/// Returns the range of a cubic interpolant of samples in the range `r`.
BrickRange widen_for_cubic(const BrickRange& r);

}  // namespace catena::render
