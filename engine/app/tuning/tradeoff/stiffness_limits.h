/// The largest spring that a device can show: derived, and simulated with the very tick on a plane. Off the tick.
#pragma once

namespace catena::app {

/// A device, a rate, and a plane to feel.
struct StiffnessSetting {
  double damping = 0.5;  ///< the device's own, N s/m
  double rate_hz = 1000, delay_s = 0;
  double virtual_damping = 0;  ///< of the coupling, N s/m
  double mass_kg = 0.159;
};

/// 2 b / (T + 2 t_d) (haptics/device/mass_model.h), N/m.
double max_passive_stiffness(const StiffnessSetting& setting);
/// The largest at which a mass that is let go 1 mm from the plane comes to rest, N/m; 0: none.
double max_stable_stiffness(const StiffnessSetting& setting);

}  // namespace catena::app
