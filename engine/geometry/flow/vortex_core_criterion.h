/// Private to this room: what a vortex core is sought in. Velocity v and its gradient at a place, and what a criterion says there.
///   of a grid   v as the field is read, linear or cubic; grad v formed at the nodes and mixed linearly between them, so that it is
///               continuous across the faces of cells. At a node: central differences, averaged over the 3 x 3 rows beside it by 1, 2, 1;
///               where one of the 26 neighbours is missing (border, mask) the difference of the node's own row, central or one-sided
///   else        compute_velocity_gradient (derivatives.h): central differences over 2e-6 L
/// Lengths in world units; v divided by one scale of the whole field, so that its magnitude is irrelevant. One object a thread.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "engine/field/grid/grid.h"
#include "engine/geometry/flow/vortex_cores.h"

namespace catena::flow {

/// Two unit vectors square to the unit vector `axis` and to each other.
void perpendicular_basis(const Vec3& axis, Vec3& a, Vec3& b);

/// The nodes of a box of a grid, and which of them are corners of a valid cell.
class NodeBlock {
 public:
  /// Of `nodes` nodes an axis, from `origin` on.
  void read(const field::VectorGrid& grid, const field::Index3& origin, int nodes);
  /// Whether the cell at the node (i, j, k) of the block is valid.
  bool has_cell(int i, int j, int k) const { return cells_[cell(i, j, k)] != 0; }
  bool is_empty() const { return empty_; }  ///< no cell is valid, or no two values differ
  /// As the file has it.
  Vec3 value(int i, int j, int k) const {
    const float* v = xyz_.data() + 3 * at(i, j, k);
    return {v[0], v[1], v[2]};
  }
  /// By index, of an inner node; false where a neighbour that it needs is missing.
  bool gradient(int i, int j, int k, Mat3& by_index) const;

 private:
  std::size_t at(int i, int j, int k) const { return static_cast<std::size_t>(i + n_ * (j + n_ * k)); }
  std::size_t cell(int i, int j, int k) const { return static_cast<std::size_t>(i + (n_ - 1) * (j + (n_ - 1) * k)); }
  int n_ = 0;
  bool empty_ = true;
  std::vector<float> xyz_;
  std::vector<std::uint8_t> cells_, valid_nodes_;
};

/// What a criterion says at a place.
struct CoreSample {
  Vec3 residual{0.0};      ///< 0 on a core; a part of v, or in its unit
  Vec3 axis{0.0};          ///< of the rotation, unit
  Vec3 step{0.0};          ///< about the way to the core, across the axis, world units
  double swirl = 0;        ///< the imaginary part of the complex pair, 1 / world unit and by the scale
  bool is_inside = false;  ///< inside the domain and mask
  bool is_vortex = false;  ///< known, and the flow turns about the axis
};

/// The flow about a place, without its axis: v and grad v (column j is dv / dx_j).
struct CoreFlow {
  Vec3 v{0.0};
  Mat3 gradient{0.0};
};

/// A criterion at a place whose flow is known. `second`: D^2 v / Dt^2, of parallel vectors alone.
CoreSample evaluate_criterion(CoreCriterion criterion, const CoreFlow& flow, const Vec3& second, double length);

class CoreField {
 public:
  CoreField(const field::VectorField& field, CoreCriterion criterion, double scale);
  /// What the criterion says at a place.
  CoreSample sample_at(const Vec3& world);
  /// The same of a flow that is known already, at a place.
  CoreSample evaluate(const Vec3& world, const CoreFlow& flow);
  bool sample_flow(const Vec3& world, CoreFlow& out);

 private:
  bool acceleration(const Vec3& world, Vec3& out);
  const field::VectorField& field_;
  CoreCriterion criterion_;
  double scale_, difference_step_;
  field::Cursor cursor_;
  /// The gradients at a cell's corners, by index. The last ones are kept, each at a place that its base says.
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
