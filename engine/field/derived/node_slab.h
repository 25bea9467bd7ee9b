// SPDX-License-Identifier: MIT
/// Nodes of some layers of a grid, with the layers around them, and their derivatives by differences along the index axes. Private to this
/// module.
///   first derivative    central over two neighbors (order 4: over four); at a border of the box or mask one-sided over two neighbors, of
///                       second order; over one neighbor where there is no second one
///   second derivative   central over two (four) neighbors; one-sided over three or two; mixed ones by the product of two first
///   derivatives,
///                       at masks by the four nodes of a quadrant
/// A derivative along an axis of one node is 0. Where a neighbor is missing for all of these there is none: NaN.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "engine/field/grid/grid.h"

namespace catena::field {

/// Weights of a difference along an axis, in voxels.
struct Stencil {
  int count = 0;  ///< 0: there is none
  std::array<int, 5> offset{};
  std::array<double, 5> weight{};
};

/// Nodes of a grid with C components, by layers of constant z.
template <class Grid>
class NodeSlab {
 public:
  static constexpr int C = std::is_same_v<Grid, ScalarGrid> ? 1 : 3;
  /// `derivatives`: highest one that is asked for; `order`: 2 or 4.
  NodeSlab(const Grid& grid, int derivatives, int order = 2);
  const Index3& size() const { return size_; }  ///< nodes of the box
  /// Reads layers z .. z + layers - 1 of the box, and those around them that exist.
  void read(int z, int layers);
  /// Returns whether a node of these layers is a corner of a valid cell and finite.
  bool is_valid(int x, int y, int z) const { return valid_.empty() || valid_[at(x, y, z)] != 0; }
  bool has_mask() const { return !valid_.empty(); }  ///< false: all nodes are valid
  /// Returns whether cells whose corners are all valid may be excluded.
  bool has_cell_mask() const { return grid_.storage().has_cell_mask; }
  /// Returns whether the cell at a base node may be valid.
  bool may_be_cell(int x, int y, int z) const;

  double value(int c, int x, int y, int z) const { return values_[std::size_t(c)][at(x, y, z)]; }
  /// Returns the derivatives by index of a component at a node.
  Vec3 first(int c, int x, int y, int z) const;
  /// Returns the matrix of second derivatives by index.
  Mat3 second(int c, int x, int y, int z) const;
  /// Writes the derivatives by index along `axis` of a row of nodes; only without a mask.
  void first_of_row(int c, int axis, int y, int z, double* out) const;

 private:
  std::size_t at(int x, int y, int z) const {
    return (std::size_t(z - first_) * std::size_t(size_.y) + std::size_t(y)) * std::size_t(size_.x) + std::size_t(x);
  }
  bool has(int axis, const Index3& node, int offset) const;
  Stencil first_stencil(int axis, const Index3& node) const;
  Stencil second_stencil(int axis, const Index3& node) const;
  double apply(const Stencil& stencil, int c, int axis, const Index3& node) const;
  double mixed(int c, int a, int b, const Index3& node) const;
  void mark_valid();

  const Grid& grid_;
  int order_, halo_;
  Index3 origin_, size_;
  int first_ = 0, layers_ = 0;  ///< layers in memory
  std::array<std::ptrdiff_t, 3> stride_{};
  std::array<std::vector<float>, std::size_t(C)> values_;
  std::vector<float> read_;
  std::vector<std::uint8_t> valid_;
};

}  // namespace catena::field
