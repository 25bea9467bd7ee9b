/// Online streamline (paper, Eqs. 3-4, safeguarded): integrates from the last proxy toward the probe x in every tick.
///   u = v/|v|, g = (x - p).u;  step h = g / max(|1 - kappa N.(x - p)|, 0.1), no longer than the trust radius
///   g changes sign: root on the step's Hermite, then one true step lands on it; Armijo on |x - p|^2 / 2
///   a step that turns by more than 60 degrees is halved; tried at 1e-7 L and still turning, or a zero within 1e-4 L: CRITICAL,
///   held while the probe is beyond it, until it turns back; a step on to where a line field is incoherent: the same, with that
///   reason; a step that leaves the domain is halved down to 1e-9 L: BOUNDARY, held likewise.
/// `linear` is Eqs. 1-2 as printed: one Euler step a tick, nothing corrected.
/// At most kEvaluationCap evaluations a tick, then BUDGET. Haptic thread: no allocation, lock or throw.
#pragma once
#include <memory>
#include <optional>

#include "engine/flow/flow.h"
#include "haptics/chain/constraint.h"

namespace catena::haptics {

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
