/// A point mass held by a hand, between two instants a period apart: exact for the linear part, whatever the period.
///   m x'' = F + k_h (w - x) + b_h (w' - x') - b x' - f_c x'/|x'|,   F and w' constant over a step
/// Each step of a period is cut into a few; within one w is its mean, and the linear rest is solved exactly (the matrix
/// exponential), so that a held force gives the true sampled-data system: without friction and hand any step is exact.
/// Friction (Coulomb, the same in all directions): an impulse against the velocity that a step would end with, at most f_c;
/// where less stops it, it stops, and a mass at rest stays at rest to the bit while |F + k_h (w - x)| <= f_c.
/// Metres, newtons, seconds. Only + - * / sqrt in a step. Haptic thread.
#pragma once
#include "engine/base/vec.h"

namespace catena::haptics {

/// The linear part over `step_s`: from (0, v) with the force u held: x = x_from_v v + x_from_u u;  v' = v_from_v v + v_from_u u.
struct LinearStep {
  double step_s = 0;
  double x_from_v = 0, x_from_u = 0, v_from_v = 1, v_from_u = 0;
};

/// Of m x'' = u - k x - b x'. Off the tick.
LinearStep linear_step(double mass_kg, double damping_ns_per_m, double stiffness_n_per_m, double step_s);

struct MassState {
  Vec3 position_m{0.0};
  Vec3 velocity_m_per_s{0.0};
};

/// One step under the constant force u (at the step's start: spring and wish included), against friction.
void advance(const LinearStep& step, const Vec3& force_n, double friction_n, MassState& state) noexcept;

}  // namespace catena::haptics
