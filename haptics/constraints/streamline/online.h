/// Online steps through the cells of a sampled line field. Every stage uses the dyads of the cell that the step starts in, and a step
/// ends on the face by which it leaves the cell: there the interpolant has a kink, which no embedded error estimate sees, and
/// neighbouring fibres of noisy data part quickly. So the online proxy stays on the line that is traced and drawn.
/// Haptic thread: no allocation, lock or throw; at most kHops cells and 13 steps of the method a call.
#pragma once
#include <memory>
#include <optional>

#include "engine/flow/flow.h"
#include "engine/flow/medium.h"
#include "haptics/chain/constraint.h"

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

/// Online streamline (paper, Eqs. 3-4, safeguarded): integrates from the last proxy toward the probe x in every tick.
///   u = v/|v|, g = (x - p).u;  step h = g / max(|1 - kappa N.(x - p)|, 0.1), no longer than the trust radius
///   g changes sign: root on the step's Hermite, then one true step lands on it; Armijo on |x - p|^2 / 2
///   a step that turns by more than 60 degrees is halved; tried at 1e-7 L and still turning, or a zero within 1e-4 L: CRITICAL,
///   held while the probe is beyond it, until it turns back; a step on to where a line field is incoherent: the same, with that
///   reason; a step that leaves the domain is halved down to 1e-9 L: BOUNDARY, held likewise.
/// `linear` is Eqs. 1-2 as printed: one Euler step a tick, nothing corrected.
/// At most kEvaluationCap evaluations a tick, then BUDGET. Haptic thread: no allocation, lock or throw.
struct OnlineSpec {
  field::VectorFieldPtr field;
  bool line = false;
  double min_speed = 0;
  flow::Method method = flow::Method::rkf34;
  double tolerance = 1e-9;   ///< of the embedded error of one step, times L
  std::optional<Vec3> seed;  ///< none: the probe where the link is switched on
};

/// What the link remembers.
struct OnlineMemory {
  enum Mode : std::int32_t { seeking, following, at_zero, at_boundary, at_incoherent };
  Mode mode = seeking;
  std::int32_t tried = 0;        ///< searches for a zero in this tick
  Reason reason = Reason::none;  ///< why it is held, or seeks
  Vec3 t{0.0};                   ///< unit direction at the proxy
  Vec3 curvature{0.0};           ///< dt/ds of the last step
  double trust = 0;              ///< longest step that the error control takes now, world units
  Vec3 hold{0.0};                ///< held while (x - hold).way >= 0
  Vec3 way{0.0};
  Vec3 p_in{0.0}, t_in{0.0};    ///< where the line goes on from when it is let go
  Vec3 calm{0.0}, t_calm{0.0};  ///< last place with a radius of curvature above 1e-3 L: before the turn at a saddle
};

std::shared_ptr<const Constraint> make_online_streamline(const OnlineSpec& spec);

}  // namespace catena::haptics
