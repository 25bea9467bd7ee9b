/// Online steps through the cells of a sampled line field. Every stage uses the dyads of the cell that the step starts in, and a step
/// ends on the face by which it leaves the cell: there the interpolant has a kink, which no embedded error estimate sees, and
/// neighbouring fibres of noisy data part quickly. So the online proxy stays on the line that is traced and drawn.
/// Haptic thread: no allocation, lock or throw; at most kHops cells and 13 steps of the method a call.
#pragma once
#include "engine/flow/medium.h"

namespace catena::haptics {

class CellSteps {
 public:
  CellSteps(const flow::Flow& flow, field::Cursor& cursor) : medium_(flow, &cursor), domain_(flow.field->length()) {}

  /// From p over the length h > 0 in the direction way * t (way +1 or -1); h becomes shorter where the step ends on a face.
  /// World coordinates; `last` is turned as t is. Stop::outside: there is no cell that way.
  flow::Step step(const flow::Tableau& tableau, const Vec3& p, const Vec3& t, double way, double& h) noexcept {
    const Vec3 motion = way * t;
    int evaluations = 0;
    const auto rate = [&](const Vec3& q, Vec3& w) {
      Vec3 u;
      ++evaluations;
      const flow::Stop stop = medium_.rate(q, w, u);
      return stop == flow::Stop::none && dot(u, motion) < 0.5 ? flow::Stop::turned : stop;
    };
    flow::Step step;
    Vec3 q, w, u;
    step.stop = medium_.begin(p, motion, 1, q) ? flow::Stop::none : flow::Stop::outside;
    for (int hop = 0; hop < kHops && step.stop == flow::Stop::none; ++hop) {
      ++evaluations;
      step.stop = medium_.rate(q, w, u);
      if (step.stop != flow::Stop::none) break;
      step = flow::runge_kutta_step(tableau, q, w, h, true, rate);
      if (step.stop != flow::Stop::none) break;
      flow::WayOut out;
      if (!medium_.leave(flow::Hermite(q, step.displacement, h, w, step.last), out)) break;
      if (out.theta * h > kOnFace * domain_) {
        land_on_face(medium_, tableau, q, w, out, domain_, rate, h, step);
        break;
      }
      if (!medium_.hop(out)) step.stop = flow::Stop::outside;
    }
    step.evaluations = evaluations;
    step.displacement = medium_.world_difference(step.displacement);
    step.last = way * direction(medium_.world_difference(step.last));
    step.error = medium_.world_difference(step.error);
    return step;
  }

 private:
  static constexpr int kHops = 6;
  static constexpr double kOnFace = 1e-14;  ///< of L: closer to a face than this is on it

  flow::CellMedium medium_;
  double domain_;
};

}  // namespace catena::haptics
