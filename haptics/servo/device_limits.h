/// What a device may be asked for: its own capabilities, bounded by what the person says. Off the tick.
/// A device with force output, where the settings do not say otherwise:
///   stiffness   the safe one at the servo's rate, min(2 b / (T + 2 t_d), f_c / encoder step): 0, and nothing is felt, where the
///               mechanism's damping b is not stated, or f_c beside an encoder step; rotational the same
///   force       the device's most; a larger number of the person's is taken at its word
///   slew        from nothing to the device's maximum force in 2 ms: max_force / 2 ms, at most 10 kN/s. Contact at hand speed is slower
///   ramp in     0.5 s;  ramp out 20 ms after more than 5 late ticks
///   passivity   observed and controlled; the controller adds at most m / (4 (T + t_d)) of damping: from about four
///               times that on (m / T without delay), damping itself shakes the device
/// A device that vibrates: the ramp in alone, so that a controller that is found again does not buzz with all of the force at once.
/// A device without either (mouse, null, recorded path): none of this, but what the person states.
#pragma once
#include "haptics/chain/constraint.h"
#include "haptics/device/device_settings.h"

namespace catena::haptics {

/// The mechanism, with what the settings say of it, in metres of hand (the map's scale: mass / s, damping / s, encoder step * s).
Mechanics resolve_mechanics(const DeviceCapabilities& device, const DeviceSettings& settings);
/// What the passivity controller may add: m / (4 (T + t_d)).
double max_added_damping(double mass_kg, double period_s, double delay_s);
/// The limits for build_program().
DeviceLimits compute_device_limits(const DeviceCapabilities& device, const DeviceSettings& settings);

}  // namespace catena::haptics
