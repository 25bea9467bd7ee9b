// SPDX-License-Identifier: MIT
/// Sources of the direction along a traced line: a formula in world coordinates, or a grid cell by cell in index coordinates, so that cell
/// faces are exact numbers. Both classes have the interface that the exact tracer (trace.cpp) uses:
///   start(seed, u, sign, q)   starts at the seed, along sign * u; false: outside the domain
///   rate(q, w, u)             u the unit direction of motion in the world, w = dq/ds; or why there is none
///   advance_cell(q, w)        makes the cell that the motion enters the current cell
///   find_exit(piece, exit)    finds the first point where a Hermite piece leaves the current cell
/// Off the haptic thread, but without allocation.
#pragma once
#include "engine/field/grid/grid.h"
#include "engine/geometry/flow/curve.h"
#include "engine/geometry/flow/flow.h"
#include "engine/geometry/flow/runge_kutta.h"

namespace catena::flow {

/// Result of advance_cell(): same cell, moved to another cell, or no cell beyond the face.
enum class CellAdvance { here, moved, boundary };

/// An exit from a cell: the Hermite parameter, and axis, coordinate and side of the face.
struct CellExit {
  double theta = 0;
  int axis = 0;
  double face = 0;
  int side = 0;  ///< -1: lower face; +1: upper face.
};

/// Analytic fields, and any other field without cells: there are no faces.
class FormulaFlowSource {
 public:
  explicit FormulaFlowSource(const Flow& flow) : flow_(flow) {}
  /// Computes the direction u of the field at the seed, or why there is none.
  StopReason seed_tangent_at(const Vec3& position, Vec3& u) {
    const StopReason stop = seed_direction(flow_, position, cursor_, u);
    if (stop == StopReason::outside) outside_status_ = flow_.field->status_outside(position, cursor_);
    return stop;
  }
  SampleStatus outside_status() const { return outside_status_; }  ///< Status of the last position outside the domain.
  bool start(const Vec3& seed, const Vec3& u, double sign, Vec3& q) {
    q = seed;
    reference_ = sign * u;
    sign_ = flow_.is_line_field ? 1 : sign;
    return true;
  }
  Vec3 world(const Vec3& q) const { return q; }
  Vec3 world_difference(const Vec3& d) const { return d; }
  glm::vec3 rounding_error(const Vec3&) const { return glm::vec3(0.0f); }  ///< Rounding error of world(q); always 0.
  StopReason rate(const Vec3& q, Vec3& w, Vec3& u) {
    const StopReason stop = direction_at(flow_, q, reference_, cursor_, u);
    if (stop == StopReason::outside) outside_status_ = flow_.field->status_outside(q, cursor_);
    u *= sign_;
    w = u;
    return stop;
  }
  CellAdvance advance_cell(Vec3&, const Vec3&) { return CellAdvance::here; }
  bool find_exit(const Hermite&, CellExit&) const { return false; }
  bool cross_face(const CellExit&) { return true; }
  void set_reference(const Vec3& motion) { reference_ = motion; }
  double max_step() const { return 0.1 * flow_.field->domain_length(); }

 private:
  Flow flow_;
  field::Cursor cursor_;
  Vec3 reference_{0.0};
  double sign_ = 1;
  SampleStatus outside_status_ = SampleStatus::ok;
};

/// Finds the first point where a Hermite piece leaves the box from `lower` to `upper`. Returns false when it stays inside.
bool find_exit_of_box(const Hermite& piece, const Vec3& lower, const Vec3& upper, CellExit& exit);

/// Moves to the cells that the motion w enters while q lies on (or beyond) a face of the current cell, whose faces are `lower` and `upper`.
/// `cross` enters the neighbor behind an exit, which changes these faces, or returns false. At the boundary q is put onto the face.
template <class Cross>
CellAdvance advance_through_faces(Vec3& q, const Vec3& w, const Vec3& lower, const Vec3& upper, Cross&& cross) {
  CellAdvance result = CellAdvance::here;
  for (int crossings = 0; crossings < 6; ++crossings) {
    int axis = 0, side = 0;
    for (; axis < 3; ++axis) {
      side = q[axis] < lower[axis] || (q[axis] == lower[axis] && w[axis] < 0)
                 ? -1
                 : q[axis] > upper[axis] || (q[axis] == upper[axis] && w[axis] > 0);
      if (side != 0) break;
    }
    if (axis == 3) return result;
    if (!cross(CellExit{0, axis, 0, side})) {
      q[axis] = side < 0 ? lower[axis] : upper[axis];
      return CellAdvance::boundary;
    }
    result = CellAdvance::moved;
  }
  return result;
}

/// A sampled field: within a cell every stage uses the polynomial of that cell (line fields: its dyads), extrapolated as far as a stage
/// reaches. Index coordinates are relative to the grid's first voxel where indices are far from 0, so that they stay exact.
class CellFlowSource {
 public:
  /// `cursor`: cache of grid accessors to use; null: a cursor of its own.
  explicit CellFlowSource(const Flow& flow, field::Cursor* cursor = nullptr);
  SampleStatus outside_status() const { return outside_status_; }  ///< Status of the last cell that could not be entered.
  StopReason seed_tangent_at(const Vec3& position, Vec3& u);
  bool start(const Vec3& seed, const Vec3& u, double sign, Vec3& q);
  Vec3 world(const Vec3& q) const { return mapping_.world_from_index(q); }
  Vec3 world_difference(const Vec3& d) const { return mapping_.world_from_index_linear * d; }
  /// Rounding error of world(q) where the position is so far from the origin that it exceeds about 1e-13 L; else 0.
  glm::vec3 rounding_error(const Vec3& q) const;
  StopReason rate(const Vec3& q, Vec3& w, Vec3& u) const;
  /// Vector of the current cell at q, world axes, with the sign of start(); not for line fields.
  Vec3 velocity(const Vec3& q) const {
    const Vec3 f = q - lo_;
    if (cubic_) return sign_ * field::cubic_vector_within(samples_, f);
    const auto& c = polynomial_;
    return (c[0] + f.x * c[1]) + f.y * (c[2] + f.x * c[3]) + f.z * ((c[4] + f.x * c[5]) + f.y * (c[6] + f.x * c[7]));
  }
  const Vec3& lower_faces() const { return lo_; }             ///< Lower faces of the current cell, index coordinates.
  const Vec3& upper_faces() const { return hi_; }             ///< Upper faces of the current cell, index coordinates.
  const field::Mapping& mapping() const { return mapping_; }  ///< Mapping of the index coordinates.
  /// Moves to neighboring cells while q lies on (or beyond) a face and w points outward. At the boundary q is put onto the face.
  CellAdvance advance_cell(Vec3& q, const Vec3& w);
  /// Finds the first point where `piece` leaves the current cell. Returns false when it stays inside.
  bool find_exit(const Hermite& piece, CellExit& exit) const { return find_exit_of_box(piece, lo_, hi_, exit); }
  /// Enters the neighboring cell behind a face. Returns false when there is none or it is not valid.
  bool cross_face(const CellExit& exit);
  void set_reference(const Vec3& motion) { reference_ = motion; }
  double max_step() const { return max_step_; }

 private:
  bool enter_cell(const field::Index3& base);
  field::VectorCell load_cell(const field::Index3& base);

  field::Cursor& cursor() { return shared_cursor_ != nullptr ? *shared_cursor_ : own_cursor_; }

  Flow flow_;
  const field::VectorGrid* grid_;
  field::Index3 first_;     ///< Origin of the index coordinates used here.
  field::Mapping mapping_;  ///< Mapping of these index coordinates.
  field::Box box_;
  field::Cursor* shared_cursor_;
  field::Cursor own_cursor_;
  field::Index3 base_;
  Vec3 lo_{0.0}, hi_{0.0};          ///< Faces of the current cell, index coordinates.
  std::array<Vec3, 8> polynomial_;  ///< Vector field: coefficients of 1, x, y, xy, z, xz, yz, xyz.
  bool cubic_;
  field::CubicSamples<3> samples_;  ///< Cubic vector field: used instead of polynomial_.
  field::DyadCell dyads_;           ///< Line field: dyads of the current cell.
  Vec3 reference_{0.0};             ///< Last tangent: line fields are oriented to its side.
  double sign_ = 1;
  SampleStatus outside_status_ = SampleStatus::ok;
  double max_step_ = 0;
};

/// Position in a state of land_on_face(), which has an overload for each type of state.
inline const Vec3& position_of(const Vec3& q) { return q; }

/// Shortens a step of length h from q (rate w there) that leaves the cell through `exit`, so that it ends on the face: repeats true steps
/// until |q - face| <= `accuracy` L. `rate` is that of the cell; `domain` is L. Returns false when a stage stopped; `step.stop` holds the
/// reason.
template <class Medium, class State, class Rate>
bool land_on_face(const Medium& medium, const Tableau& tableau, const State& q, const State& w, const CellExit& exit, double domain,
                  Rate&& rate, double& h, StepOf<State>& step, double accuracy = 1e-14) {
  double lo = 0, hi = h, at = exit.theta * h;
  const double unit = norm(medium.world_difference(Vec3(exit.axis == 0, exit.axis == 1, exit.axis == 2)));
  for (int i = 0; i < 12; ++i) {
    step = runge_kutta_step(tableau, q, w, at, true, rate);
    if (step.stop != StopReason::none) return false;
    const double miss = exit.side * (position_of(q)[exit.axis] + position_of(step.displacement)[exit.axis] - exit.face);
    if (std::fabs(miss) * unit <= accuracy * domain) break;
    (miss < 0 ? lo : hi) = at;
    const double next = at - miss / (exit.side * position_of(step.end_rate)[exit.axis]);
    if (!(hi - lo > 1e-16 * h)) break;
    at = next > lo && next < hi ? next : 0.5 * (lo + hi);
  }
  h = at;
  return true;
}

}  // namespace catena::flow
