/// A point mass held by a hand, between two instants a period apart: exact for the linear part, whatever the period.
///   m x'' = F + k_h (w - x) + b_h (w' - x') - b x' - f_c x'/|x'|,   F and w' constant over a step
/// Each step of a period is cut into a few; within one w is its mean, and the linear rest is solved exactly (the matrix
/// exponential), so that a held force gives the true sampled-data system: without friction and hand any step is exact.
/// Friction (Coulomb, the same in all directions): an impulse against the velocity that a step would end with, at most f_c;
/// where less stops it, it stops, and a mass at rest stays at rest to the bit while |F + k_h (w - x)| <= f_c.
/// Metres, newtons, seconds. Only + - * / sqrt in a step. Haptic thread.
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

/// Of m x'' = u - k x - b x'. Off the tick.
LinearStep make_linear_step(double mass_kg, double damping_ns_per_m, double stiffness_n_per_m, double step_s);

struct MassState {
  Vec3 position_m{0.0};
  Vec3 velocity_m_per_s{0.0};
};

/// One step under the constant force u (at the step's start: spring and wish included), against friction.
void advance_mass(const LinearStep& step, const Vec3& force_n, double friction_n, MassState& state) noexcept;

/// The stiffest spring that a device can show and stay passive, from what is known of its mechanism.
///   K <= 2 b / (T + 2 t_d)    the sampled spring makes up K T/2 |dx| |v| a second; a force that comes t_d late, K t_d more; the
///                             device's own damping b must take it: b > K T/2 + K t_d. Without delay 2 b / T: J. E. Colgate,
///                             G. Schenkel, "Passivity of a class of sampled-data systems", J. Robotic Systems 14(1), 1997;
///                             with delay: N. Diolaiti, G. Niemeyer, F. Barbagli, J. K. Salisbury, "Stability of haptic
///                             rendering: discretization, quantization, time delay, and Coulomb effects", IEEE Trans.
///                             Robotics 22(2), 2006
///   K <= f_c / step           what an encoder's step makes up, K step/2 a length, Coulomb friction f_c must take: J. J. Abbott,
///                             A. M. Okamura, "Effects of position quantization and sampling rate on virtual-wall passivity",
///                             IEEE Trans. Robotics 21(5), 2005. A hand that rests is held within one step (still_pose.h), which
///                             doubles the step
/// An encoder step of 0 (continuous) takes the second bound away. A damping of 0 makes the first one 0, a friction of 0 with a
/// step the second: no spring at all is passive on such a device, and a number of one's own ("stiffness_cap") has to say what
/// is wanted. The mass does not matter. A virtual damping B widens stability but narrows passivity (b > K T/2 + B): not counted.
/// Newtons, metres of hand, seconds. Off the tick.
struct SafeStiffness {
  double by_damping_n_per_m = 0;   ///< 2 b / (T + 2 t_d)
  double by_friction_n_per_m = 0;  ///< f_c / step; infinite without a step
  double min_n_per_m() const { return by_friction_n_per_m < by_damping_n_per_m ? by_friction_n_per_m : by_damping_n_per_m; }
};

SafeStiffness safe_stiffness(const Mechanics& mechanics, double period_s);

/// The same of a torque, N m a radian: 2 b_r / (T + 2 t_d); 0 where the rotational damping is not known.
double safe_rotational_stiffness(const Mechanics& mechanics, double period_s);

/// One line: "1000 N/m: 2 b / T = 1000, f_c / step = 5000", and what to state where it is 0.
std::string describe_safe_stiffness(const Mechanics& mechanics, double period_s);

}  // namespace catena::haptics
