// SPDX-License-Identifier: MIT
/// A point mass held by a simulated user, between two instants one period apart: exact for the linear part, whatever the period.
///   m x'' = F + k_h (w - x) + b_h (w' - x') - b x' - f_c x'/|x'|,   F and w' constant over a step; w the user's target position
/// Each period is divided into a few steps; within one step w is its mean, and the linear part is solved exactly (the matrix
/// exponential), so that a held force gives the true sampled-data system: without friction and user any step is exact.
/// Friction (Coulomb, isotropic): an impulse against the velocity at the end of the step, at most f_c; where less than that stops the
/// mass, it stops, and a mass at rest stays at rest bit for bit while |F + k_h (w - x)| <= f_c.
/// Meters, newtons, seconds. A step uses only + - * / sqrt. Haptic thread.
#pragma once
#include <string>

#include "engine/base/vec.h"
#include "haptics/device/device.h"

namespace catena::haptics {

/// The linear part over `step_s`: from (0, v) with the force u held: x = x_from_v v + x_from_u u;  v' = v_from_v v + v_from_u u.
struct LinearStep {
  double step_s = 0;
  double x_from_v = 0, x_from_u = 0, v_from_v = 1, v_from_u = 0;
};

/// Returns the step of m x'' = u - k x - b x'. Off the tick.
LinearStep make_linear_step(double mass_kg, double damping_ns_per_m, double stiffness_n_per_m, double step_s);

/// State of the point mass.
struct MassState {
  Vec3 position_m{0.0};
  Vec3 velocity_m_per_s{0.0};
};

/// Advances one step under the constant force (at the start of the step: spring and target included), against friction.
void advance_mass(const LinearStep& step, const Vec3& force_n, double friction_n, MassState& state) noexcept;

/// The stiffest spring that a device can render passively, from the known parameters of its mechanism.
///   K <= 2 b / (T + 2 t_d)    the sampled spring generates K T/2 |dx| |v| per second; a force that is t_d late, K t_d more; the
///                             device's own damping b must dissipate it: b > K T/2 + K t_d. Without delay 2 b / T: J. E. Colgate,
///                             G. Schenkel, "Passivity of a class of sampled-data systems", J. Robotic Systems 14(1), 1997;
///                             with delay: N. Diolaiti, G. Niemeyer, F. Barbagli, J. K. Salisbury, "Stability of haptic
///                             rendering: discretization, quantization, time delay, and Coulomb effects", IEEE Trans.
///                             Robotics 22(2), 2006
///   K <= f_c / step           what an encoder step generates, K step/2 per length, Coulomb friction f_c must dissipate: J. J. Abbott,
///                             A. M. Okamura, "Effects of position quantization and sampling rate on virtual-wall passivity",
///                             IEEE Trans. Robotics 21(5), 2005. A probe at rest is held within one step (dither_filter.h), which
///                             doubles the step
/// An encoder step of 0 (continuous) removes the second bound. A damping of 0 makes the first one 0, a friction of 0 with a
/// step the second: no spring at all is passive on such a device, and a stated value ("stiffness_cap") has to replace the bound.
/// The mass does not matter. A virtual damping B widens stability but narrows passivity (b > K T/2 + B): not counted.
/// Newtons, meters of probe travel, seconds. Off the tick.
struct SafeStiffness {
  double by_damping_n_per_m = 0;   ///< 2 b / (T + 2 t_d)
  double by_friction_n_per_m = 0;  ///< f_c / step; infinite without a step
  /// Returns the smaller of the two bounds.
  double min_n_per_m() const { return by_friction_n_per_m < by_damping_n_per_m ? by_friction_n_per_m : by_damping_n_per_m; }
};

/// Returns both bounds; period_s: T, the tick's period.
SafeStiffness safe_stiffness(const Mechanics& mechanics, double period_s);

/// Returns the rotational bound, N m per radian: 2 b_r / (T + 2 t_d); 0 where the rotational damping is unknown.
double safe_rotational_stiffness(const Mechanics& mechanics, double period_s);

/// Returns one line: "1000 N/m: 2 b / T = 1000, f_c / step = 5000", and what to state where it is 0.
std::string describe_safe_stiffness(const Mechanics& mechanics, double period_s);

}  // namespace catena::haptics
