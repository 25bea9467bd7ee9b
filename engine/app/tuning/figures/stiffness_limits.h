// SPDX-License-Identifier: MIT
/// Largest spring stiffness that a haptic device can render: derived, and simulated with the real tick on a plane. Not for the haptic
/// thread.
#pragma once

namespace catena::app {

/// Parameters of a device in contact with a plane.
struct StiffnessSetting {
  double damping = 0.5;  ///< Damping of the device itself, N s/m.
  /// Rate of the servo; delay of the loop, seconds.
  double rate_hz = 1000, delay_s = 0;
  double virtual_damping = 0;  ///< Damping of the coupling, N s/m.
  double mass_kg = 0.159;
};

/// Returns the passivity limit 2 b / (T + 2 t_d) in N/m (haptics/device/mass_model.h).
double max_passive_stiffness(const StiffnessSetting& setting);
/// Returns the largest stiffness, N/m, at which a mass released 1 mm from the plane comes to rest; 0 if there is none.
double max_stable_stiffness(const StiffnessSetting& setting);

}  // namespace catena::app
