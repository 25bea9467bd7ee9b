// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/unsteady_source.h"

namespace catena::flow {

bool FormulaPathSource::start(const Vec3& world, Vec3& q) {
  const double slack = 1e-12 * max_abs(box_.hi - box_.lo);
  for (int axis = 0; axis < 3; ++axis)
    if (!(world[axis] >= box_.lo[axis] - slack && world[axis] <= box_.hi[axis] + slack)) return false;
  q = glm::clamp(world, box_.lo, box_.hi);
  return true;
}

CellAdvance FormulaPathSource::advance_cell(Vec3& q, const Vec3& w) {
  return advance_through_faces(q, w, box_.lo, box_.hi, [](const CellExit&) { return false; });
}

CellPathSource::CellPathSource(const TimeInterval& interval) : interval_(interval) {
  for (std::size_t i = 0; i < interval.count; ++i) steps_[i].emplace(Flow{interval_.grids[i].get(), false, 0});
}

bool CellPathSource::start(const Vec3& world, Vec3& q) {
  for (std::size_t i = 0; i < interval_.count; ++i)
    if (!steps_[i]->start(world, Vec3(0.0), 1, q)) {
      outside_status_ = steps_[i]->outside_status();
      return false;
    }
  // next to a mask the steps may have chosen different neighbors of a position on a face
  for (std::size_t i = 1; i < interval_.count; ++i)
    if (!(steps_[i]->lower_faces() == front().lower_faces())) {
      outside_status_ = SampleStatus::masked;
      return false;
    }
  return true;
}

Vec3 CellPathSource::velocity(const Vec3& q, double time) {
  if (interval_.count == 2) {
    const double theta = (time - interval_.begin) / (interval_.end - interval_.begin);
    const Vec3 first = steps_[0]->velocity(q), second = steps_[1]->velocity(q);
    return first + theta * (second - first);
  }
  const auto weights = interval_.weights(time);
  Vec3 v = weights[0] * steps_[0]->velocity(q);
  for (std::size_t i = 1; i < interval_.count; ++i) v += weights[i] * steps_[i]->velocity(q);
  return v;
}

CellAdvance CellPathSource::advance_cell(Vec3& q, const Vec3& w) {
  return advance_through_faces(q, w, front().lower_faces(), front().upper_faces(), [&](const CellExit& exit) { return cross_face(exit); });
}

bool CellPathSource::cross_face(const CellExit& exit) {
  for (std::size_t i = interval_.count; i-- > 0;)  // the first step, whose faces are used, moves last
    if (!steps_[i]->cross_face(exit)) {
      outside_status_ = steps_[i]->outside_status();
      return false;
    }
  return true;
}

}  // namespace catena::flow
