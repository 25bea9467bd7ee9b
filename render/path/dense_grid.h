// SPDX-License-Identifier: MIT
/// Voxels of a scalar grid in one array, with the range of values of each brick of 8^3 cells, for rays on the processor. Positions are in
/// index space, relative to the first voxel. Immutable after make(): any thread.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "engine/field/grid/grid.h"

namespace catena::render {

/// Copy of a scalar grid with linear or nearest interpolation.
class DenseGrid {
 public:
  /// Cells per edge of a brick.
  static constexpr int kBrick = 8;
  /// Reads the whole grid.
  static std::shared_ptr<const DenseGrid> make(const field::ScalarGrid& grid);

  /// Number of voxels along an axis; cells: one less.
  const std::array<int, 3>& size() const { return size_; }
  /// Number of bricks along an axis; all 0: no cell.
  const std::array<int, 3>& bricks() const { return bricks_; }
  /// Returns whether the cell is in the domain and not masked.
  bool is_valid_cell(int x, int y, int z) const { return valid_.empty() || valid_[index(x, y, z)] != 0; }
  /// Returns the values of the corners of a cell, corner[i + 2 j + 4 k].
  void corners(int x, int y, int z, std::array<float, 8>& out) const;
  /// Returns the value at a position, clamped to the domain. False: the cell is masked.
  bool sample(const glm::vec3& p, float& value) const;
  /// Returns the gradient in the world, by differences over a voxel in each direction.
  Vec3 gradient(const glm::vec3& p) const;
  /// Smallest and largest value in the valid cells of a brick; min > max: there are none.
  std::pair<float, float> range(int x, int y, int z) const {
    return ranges_[(std::size_t(z) * std::size_t(bricks_[1]) + std::size_t(y)) * std::size_t(bricks_[0]) + std::size_t(x)];
  }
  /// Map from index space (of the grid, not relative) to the world.
  const field::Mapping& mapping() const { return mapping_; }
  /// Returns a position relative to the first voxel.
  Vec3 to_index(const Vec3& world) const { return mapping_.index_from_world(world) - lo_; }
  /// Returns a direction in index space.
  Vec3 to_index_direction(const Vec3& world) const { return mapping_.index_from_world_linear * world; }
  /// Shortest edge of a voxel, world units.
  double voxel_edge() const { return voxel_edge_; }

 private:
  std::size_t index(int x, int y, int z) const {
    return (std::size_t(z) * std::size_t(size_[1]) + std::size_t(y)) * std::size_t(size_[0]) + std::size_t(x);
  }
  void find_ranges();

  std::array<int, 3> size_{}, bricks_{};
  Vec3 lo_{0.0};
  field::Mapping mapping_;
  double voxel_edge_ = 0;
  bool is_nearest_ = false;
  std::vector<float> values_;
  std::vector<std::uint8_t> valid_;  ///< by the cell's first voxel; empty: all are valid
  std::vector<std::pair<float, float>> ranges_;
};

}  // namespace catena::render
