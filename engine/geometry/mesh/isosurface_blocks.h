// SPDX-License-Identifier: MIT
/// Blocks of 8^3 cells through which an isosurface may pass, layer by layer. Not for the haptic tick.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/field/grid/grid.h"

namespace catena::mesh {

/// Cells of a block along each axis.
inline constexpr int kSurfaceBlock = 8;

/// Layers of blocks in ascending z. A block is left out if it and its upper neighbors have constant values on one side of the level.
class SurfaceBlocks {
 public:
  /// `name` begins the message. Error: the grid has more than 2^28 blocks, or a single layer of voxels.
  static Result<SurfaceBlocks> of(const field::ScalarGrid& grid, double level, const std::string& name);
  /// Number of layers.
  std::int64_t layers() const { return count_[2]; }
  /// Returns the first voxels of the next layer's blocks, x fastest; called layers() times.
  std::vector<field::Index3> next_layer();

 private:
  enum Side : char { kBelow, kAbove, kMixed };

  SurfaceBlocks(const field::ScalarGrid& grid, double level) : grid_(&grid), level_(level) {}
  field::Index3 block_at(std::int64_t i, std::int64_t j, std::int64_t k) const;
  /// Reads the sides of the blocks of a layer, with one more block along x and y.
  void read_sides(std::int64_t k, std::vector<char>& sides) const;

  const field::ScalarGrid* grid_;
  double level_;
  field::Index3 first_;
  std::int64_t count_[3]{};  ///< blocks per axis
  std::int64_t next_ = 0;
  std::vector<char> lower_, upper_;  ///< sides of the blocks of two layers
};

}  // namespace catena::mesh
