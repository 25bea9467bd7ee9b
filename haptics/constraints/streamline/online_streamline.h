// SPDX-License-Identifier: MIT
/// Online streamline, and its steps through the cells of a sampled line field (CellStepper).
#pragma once
#include <memory>
#include <optional>

#include "engine/geometry/flow/flow.h"
#include "engine/geometry/flow/flow_source.h"
#include "haptics/chain/constraint.h"

namespace catena::haptics {

/// Integration steps through the cells of a sampled line field. Every stage uses the dyads of the cell that the step starts in, and a
/// step ends on the face by which it leaves the cell: the interpolant has a kink there, which no embedded error estimate detects, and
/// neighboring fibers of noisy data diverge quickly. So the online proxy stays on the line that is traced and rendered.
/// Haptic thread: no allocation, lock or throw; at most kMaxHops cells and 13 steps of the method per call.
class CellStepper {
 public:
  CellStepper(const flow::Flow& flow, field::Cursor& cursor) : medium_(flow, &cursor), domain_(flow.field->domain_length()) {}

  /// Makes one step from p over the length h > 0 in the direction direction_sign * t (direction_sign +1 or -1); h is reduced where the step
  /// ends on a face. World coordinates; the returned end_rate has the orientation of t. StopReason::outside: there is no cell in that
  /// direction.
  flow::Step step(const flow::Tableau& tableau, const Vec3& p, const Vec3& t, double direction_sign, double& h) noexcept {
    const Vec3 motion = direction_sign * t;
    int evaluations = 0;
    const auto rate = [&](const Vec3& q, Vec3& w) {
      Vec3 u;
      ++evaluations;
      const flow::StopReason stop = medium_.rate(q, w, u);
      return stop == flow::StopReason::none && dot(u, motion) < 0.5 ? flow::StopReason::turned : stop;
    };
    flow::Step step;
    Vec3 q, w, u;
    step.stop = medium_.start(p, motion, 1, q) ? flow::StopReason::none : flow::StopReason::outside;
    for (int hop = 0; hop < kMaxHops && step.stop == flow::StopReason::none; ++hop) {
      ++evaluations;
      step.stop = medium_.rate(q, w, u);
      if (step.stop != flow::StopReason::none) break;
      step = flow::runge_kutta_step(tableau, q, w, h, true, rate);
      if (step.stop != flow::StopReason::none) break;
      flow::CellExit out;
      if (!medium_.find_exit(flow::Hermite(q, step.displacement, h, w, step.end_rate), out)) break;
      if (out.theta * h > kOnFace * domain_) {
        land_on_face(medium_, tableau, q, w, out, domain_, rate, h, step);
        break;
      }
      if (!medium_.cross_face(out)) step.stop = flow::StopReason::outside;
    }
    step.evaluations = evaluations;
    step.displacement = medium_.world_difference(step.displacement);
    step.end_rate = direction_sign * direction(medium_.world_difference(step.end_rate));
    step.error = medium_.world_difference(step.error);
    return step;
  }

 private:
  static constexpr int kMaxHops = 6;
  static constexpr double kOnFace = 1e-14;  ///< fraction of L: a point closer to a face is on it

  flow::CellFlowSource medium_;
  double domain_;
};

/// Online streamline (paper, Eqs. 3-4, safeguarded): integrates from the last proxy toward the probe x in every tick.
///   u = v/|v|, g = (x - p).u;  step h = g / max(|1 - kappa N.(x - p)|, 0.1), no longer than the trust radius
///   g changes sign: root on the step's Hermite interpolant, then one true step lands on it; Armijo on |x - p|^2 / 2
///   a step that turns by more than 60 degrees is halved; still turning at 1e-7 L, or a zero within 1e-4 L: CRITICAL, held while the
///   probe is beyond it, until it turns back; a step to a point where a line field is incoherent: the same, with that reason; a step that
///   leaves the domain is halved down to 1e-9 L: BOUNDARY, held likewise.
/// Method `linear` is Eqs. 1-2 as printed: one Euler step per tick, without correction.
/// At most kMaxEvaluations evaluations per tick, then BUDGET. Haptic thread: no allocation, lock or throw.
///
/// Parameters of an online streamline, as a scene states them.
struct OnlineStreamlineSpec {
  field::VectorFieldPtr field;
  bool is_line_field = false;
  double min_speed = 0;
  flow::Method method = flow::Method::rkf34;
  double tolerance = 1e-9;   ///< bound of the embedded error of one step, fraction of L
  std::optional<Vec3> seed;  ///< world units; none: the probe at which the link is switched on
};

/// State of the link between ticks. Positions in world units.
struct OnlineStreamlineMemory {
  /// Seeking a point of the field to start from; following the line; held at a zero, at the end of the domain, at an incoherent point.
  enum Mode : std::int32_t { seeking, following, at_zero, at_boundary, at_incoherent };
  Mode mode = seeking;
  std::int32_t zero_searches = 0;          ///< number of searches for a zero in this tick
  SampleStatus reason = SampleStatus::ok;  ///< cause of the hold, or of seeking
  Vec3 t{0.0};                             ///< unit direction at the proxy
  Vec3 curvature{0.0};                     ///< dt/ds of the last step, 1 / world unit
  double trust_radius = 0;                 ///< longest step that the error control allows, world units
  Vec3 hold_point{0.0};                    ///< held while (x - hold_point).hold_direction >= 0
  Vec3 hold_direction{0.0};
  Vec3 p_resume{0.0}, t_resume{0.0};          ///< point and direction at which the line continues after the hold
  Vec3 last_smooth{0.0}, t_last_smooth{0.0};  ///< last point with a radius of curvature above 1e-3 L: before the turn at a saddle
};

/// Returns the constraint. Off the tick.
std::shared_ptr<const Constraint> make_online_streamline(const OnlineStreamlineSpec& spec);

}  // namespace catena::haptics
