// SPDX-License-Identifier: MIT
/// Sources of the velocity along the path of a particle: a formula in world coordinates, or the steps of a series cell by cell in index
/// coordinates, as the sources of streamlines (flow_source.h). Both have the interface that ParticleMarch (particle.h) uses:
///   start(world, q)          starts at a position; false: outside the domain
///   velocity(q, time)        world units per unit of time, of the current cell
///   advance_cell, find_exit, cross_face   as in flow_source.h
/// Off the haptic thread, but without allocation.
#pragma once
#include <array>
#include <optional>

#include "engine/geometry/flow/flow_source.h"
#include "engine/geometry/flow/step_window.h"

namespace catena::flow {

/// A formula within its box, which is the only cell.
class FormulaPathSource {
 public:
  FormulaPathSource(UnsteadyFormula& formula, const Bounds& box) : formula_(formula), box_(box) {}
  bool start(const Vec3& world, Vec3& q);
  SampleStatus outside_status() const { return SampleStatus::outside_box; }  ///< Status behind a face.
  Vec3 velocity(const Vec3& q, double time) { return formula_.velocity(q, time); }
  Vec3 index_rate(const Vec3& velocity) const { return velocity; }
  Vec3 world(const Vec3& q) const { return q; }
  Vec3 world_difference(const Vec3& d) const { return d; }
  glm::vec3 rounding_error(const Vec3&) const { return glm::vec3(0.0f); }
  CellAdvance advance_cell(Vec3& q, const Vec3& w);
  bool find_exit(const Hermite& piece, CellExit& exit) const { return find_exit_of_box(piece, box_.lo, box_.hi, exit); }
  bool cross_face(const CellExit&) { return false; }
  double max_step() const { return 0.1 * max_abs(box_.hi - box_.lo); }

 private:
  UnsteadyFormula& formula_;
  Bounds box_;
};

/// The steps of an interval: all are in the same cell, and each has the polynomial of its own vectors there.
class CellPathSource {
 public:
  explicit CellPathSource(const TimeInterval& interval);
  bool start(const Vec3& world, Vec3& q);
  SampleStatus outside_status() const { return outside_status_; }  ///< Status of the last cell that could not be entered.
  Vec3 velocity(const Vec3& q, double time);
  Vec3 index_rate(const Vec3& velocity) const { return front().mapping().index_from_world_linear * velocity; }
  Vec3 world(const Vec3& q) const { return front().world(q); }
  Vec3 world_difference(const Vec3& d) const { return front().world_difference(d); }
  glm::vec3 rounding_error(const Vec3& q) const { return front().rounding_error(q); }
  CellAdvance advance_cell(Vec3& q, const Vec3& w);
  bool find_exit(const Hermite& piece, CellExit& exit) const { return front().find_exit(piece, exit); }
  bool cross_face(const CellExit& exit);
  double max_step() const { return front().max_step(); }

 private:
  const CellFlowSource& front() const { return *steps_[0]; }

  TimeInterval interval_;
  std::array<std::optional<CellFlowSource>, TimeInterval::kMaxSteps> steps_;
  SampleStatus outside_status_ = SampleStatus::ok;
};

}  // namespace catena::flow
