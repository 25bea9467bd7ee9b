// SPDX-License-Identifier: MIT
/// Private to this module: the criterion of a vortex core line, evaluated from velocity v and its gradient at a position.
///   grids      v as the field is interpolated, linear or cubic; grad v computed at the nodes and interpolated linearly, so that it is
///              continuous across cell faces. At a node: central differences, averaged over the 3 x 3 adjacent rows with weights 1, 2, 1;
///              where one of the 26 neighbors is missing (border, mask) the difference along the node's own row, central or one-sided
///   formulas   compute_velocity_gradient (derivatives.h): central differences over 2e-6 L
/// Lengths in world units; v is divided by one scale for the whole field, so that its magnitude is irrelevant. One object per thread.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "engine/field/grid/grid.h"
#include "engine/geometry/flow/vortex_cores.h"

namespace catena::flow {

/// Computes two unit vectors perpendicular to the unit vector `axis` and to each other.
void perpendicular_basis(const Vec3& axis, Vec3& a, Vec3& b);

/// The nodes of a block of a grid, and a flag for those that are corners of a valid cell.
class NodeBlock {
 public:
  /// Reads `nodes` nodes per axis, starting at `origin`.
  void read(const field::VectorGrid& grid, const field::Index3& origin, int nodes);
  /// Returns whether the cell based at node (i, j, k) of the block is valid.
  bool has_cell(int i, int j, int k) const { return cells_[cell(i, j, k)] != 0; }
  bool is_empty() const { return empty_; }  ///< No cell is valid, or all values are equal.
  /// Unscaled value of a node.
  Vec3 value(int i, int j, int k) const {
    const float* v = xyz_.data() + 3 * at(i, j, k);
    return {v[0], v[1], v[2]};
  }
  /// Computes the gradient by index at an inner node. Returns false when a required neighbor is missing.
  bool gradient(int i, int j, int k, Mat3& by_index) const;

 private:
  std::size_t at(int i, int j, int k) const { return static_cast<std::size_t>(i + n_ * (j + n_ * k)); }
  std::size_t cell(int i, int j, int k) const { return static_cast<std::size_t>(i + (n_ - 1) * (j + (n_ - 1) * k)); }
  int n_ = 0;
  bool empty_ = true;
  std::vector<float> xyz_;
  std::vector<std::uint8_t> cells_, valid_nodes_;
};

/// Criterion at a position.
struct CoreSample {
  Vec3 residual{0.0};      ///< Zero on a core line; a component of v, or in its unit.
  Vec3 axis{0.0};          ///< Unit axis of the rotation.
  Vec3 step{0.0};          ///< Approximate vector to the core line, perpendicular to the axis, world units.
  double swirl = 0;        ///< Imaginary part of the complex eigenvalue pair, for the scaled v; 1 / world unit.
  bool is_inside = false;  ///< Inside the domain and mask.
  bool is_vortex = false;  ///< The criterion is defined, and the flow rotates around the axis.
};

/// Scaled velocity and gradient at a position (column j of the gradient is dv / dx_j).
struct CoreFlow {
  Vec3 v{0.0};
  Mat3 gradient{0.0};
};

/// Evaluates a criterion for a known flow. `second`: D^2 v / Dt^2, used by parallel_vectors only; `length`: L of the field.
CoreSample evaluate_criterion(CoreCriterion criterion, const CoreFlow& flow, const Vec3& second, double length);

/// Evaluates a criterion in a field; caches gradients.
class CoreField {
 public:
  CoreField(const field::VectorField& field, CoreCriterion criterion, double scale);
  /// Evaluates the criterion at a position.
  CoreSample sample_at(const Vec3& world);
  /// Evaluates the criterion at a position where the flow is already known.
  CoreSample evaluate(const Vec3& world, const CoreFlow& flow);
  /// Computes the scaled velocity and gradient at a position. Returns false outside the domain and mask, or where they are undefined.
  bool sample_flow(const Vec3& world, CoreFlow& out);

 private:
  bool acceleration(const Vec3& world, Vec3& out);
  const field::VectorField& field_;
  CoreCriterion criterion_;
  double scale_, difference_step_;
  field::Cursor cursor_;
  /// Gradients by index at the corners of a cell. Recent cells are cached in slots selected by their base index.
  struct Corners {
    field::Index3 base;
    bool loaded = false, usable = false;
    std::array<Mat3, 8> gradients;
  };
  const Corners& load_corners(const field::Index3& base);
  NodeBlock block_;
  std::vector<Corners> cached_corners_;
};

}  // namespace catena::flow
