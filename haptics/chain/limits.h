/// What a device, not a scene, allows. All off by default: `replay` without a device has none. Metres of hand, newtons.
#pragma once
#include <limits>

namespace catena::haptics {

struct Limits {
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  double max_stiffness_n_per_m = kNone;                ///< cap of every k_i
  double max_rotational_stiffness_nm_per_rad = kNone;  ///< cap of the rotational coupling
  double max_force_n = kNone;                          ///< |F|, direction kept
  double max_torque_nm = kNone;                        ///< |torque|, direction kept
  double slew_n_per_s = kNone;                         ///< |dF/dt|; never delays a force's way to zero on a fault
  double ramp_in_s = 0;                                ///< 0..1 from the moment the force is switched on
  double ramp_out_s = 0.02;                            ///< to zero, after too many late ticks
  int late_ticks = 5;                                  ///< so many late ticks in a row hold the last force; more ramp out
  bool passivity = false;                              ///< observer and controller
  double damping_ns_per_m = 0;                         ///< the device's own, on which the observer may count
  double delay_s = 0;                                  ///< from the pose to the force: the observer counts the force that acted
  double max_added_damping_ns_per_m = kNone;           ///< most that the passivity controller may add; more shakes a light device
};

}  // namespace catena::haptics
