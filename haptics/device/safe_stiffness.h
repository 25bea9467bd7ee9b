/// The stiffest spring that a device can show and stay passive, from what is known of its mechanism.
///   K <= 2 b / (T + 2 t_d)    the sampled spring makes up K T/2 |dx| |v| a second; a force that comes t_d late, K t_d more; the
///                             device's own damping b must take it: b > K T/2 + K t_d. Without delay 2 b / T: J. E. Colgate,
///                             G. Schenkel, "Passivity of a class of sampled-data systems", J. Robotic Systems 14(1), 1997;
///                             with delay: N. Diolaiti, G. Niemeyer, F. Barbagli, J. K. Salisbury, "Stability of haptic
///                             rendering: discretization, quantization, time delay, and Coulomb effects", IEEE Trans.
///                             Robotics 22(2), 2006
///   K <= 2 f_c / step         what an encoder's step makes up, K step/2 a length, Coulomb friction f_c must take: J. J. Abbott,
///                             A. M. Okamura, "Effects of position quantization and sampling rate on virtual-wall passivity",
///                             IEEE Trans. Robotics 21(5), 2005
/// An encoder step of 0 (continuous) takes the second bound away. A damping of 0 makes the first one 0, a friction of 0 with a
/// step the second: no spring at all is passive on such a device, and a number of one's own ("stiffness_cap") has to say what
/// is wanted. The mass does not matter. A virtual damping B widens stability but narrows passivity (b > K T/2 + B): not counted.
/// Newtons, metres of hand, seconds. Off the tick.
#pragma once
#include <string>

#include "haptics/device/device.h"

namespace catena::haptics {

struct SafeStiffness {
  double by_damping_n_per_m = 0;   ///< 2 b / (T + 2 t_d)
  double by_friction_n_per_m = 0;  ///< 2 f_c / step; infinite without a step
  double n_per_m() const { return by_friction_n_per_m < by_damping_n_per_m ? by_friction_n_per_m : by_damping_n_per_m; }
};

SafeStiffness safe_stiffness(const Mechanics& mechanics, double period_s);

/// The same of a torque, N m a radian: 2 b_r / (T + 2 t_d); 0 where the rotational damping is not known.
double safe_rotational_stiffness(const Mechanics& mechanics, double period_s);

/// One line: "1000 N/m: 2 b / T = 1000, 2 f_c / step = 5000", and what to state where it is 0.
std::string safe_stiffness_text(const Mechanics& mechanics, double period_s);

}  // namespace catena::haptics
