/// Voxels of a box of a scalar grid and which of its cells are valid, with what they say about one brick of a mirror. (voxel_block.h has
/// what codes of 8 bits ask: validity by voxel.) Each thread its own.
#pragma once
#include <cstdint>
#include <vector>

#include "render/residency/resident_grid.h"

namespace catena::render {

struct CellBlock {
  field::Index3 voxels;  ///< an axis, the apron included
  std::vector<float> values;
  std::vector<std::uint8_t> valid;  ///< by voxel of the block (the cell based there); empty: all valid

  void read(const field::ScalarGrid& grid, const field::Index3& origin, const field::Index3& size, bool masked);
  std::size_t voxel_index(int x, int y, int z) const { return (std::size_t(z) * voxels.y + y) * voxels.x + x; }
  /// Over the corners of valid cells with base from `first` to before `end`, and what lies within `reach` of the corners.
  BrickRange compute_range(const field::Index3& first, const field::Index3& end, int reach) const;
};

/// What a cubic may make of samples in a range.
BrickRange widen_for_cubic(const BrickRange& r);

}  // namespace catena::render
