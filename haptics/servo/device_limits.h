// SPDX-License-Identifier: MIT
/// Computes the limits of a device from its capabilities and the user's settings. Off the tick.
/// A device with force output has these limits, unless the settings say otherwise:
///   stiffness   safe stiffness at the servo's rate, min(2 b / (T + 2 t_d), f_c / encoder step): 0, so that there is no force, if the
///               damping b of the mechanism is not specified, or if there is an encoder step and the friction f_c is not specified;
///               rotational stiffness likewise
///   force       maximum force of the device; a larger value in the settings is used as it is
///   slew        from zero to the maximum force of the device in 2 ms: max_force / 2 ms, at most 10 kN/s. Contacts at the speed of a hand
///               are slower
///   ramp in     0.5 s;  ramp out: 20 ms, after more than 5 late ticks
///   passivity   observed and controlled; the controller adds at most the damping m / (4 (T + t_d)): from about four times that (m / T
///               without delay) the damping itself shakes the device
/// A device that vibrates: the ramp in only, so that a controller that is tracked after a loss does not start at full strength.
/// A device without either (mouse, null, recorded path): no limits but those of the settings.
#pragma once
#include "engine/base/export.h"
#include "haptics/chain/constraint.h"
#include "haptics/device/device_settings.h"

namespace catena::haptics {

/// Returns the device's mechanics with the values from the settings, in meters of probe travel (with the scale s of the device mapping:
/// mass / s, damping / s, encoder step * s).
CATENA_EXPORT Mechanics resolve_mechanics(const DeviceCapabilities& device, const DeviceSettings& settings);
/// Returns the maximum damping that the passivity controller may add, N s/m: m / (4 (T + t_d)).
CATENA_EXPORT double max_added_damping(double mass_kg, double period_s, double delay_s);
/// Returns the limits for build_program().
CATENA_EXPORT DeviceLimits compute_device_limits(const DeviceCapabilities& device, const DeviceSettings& settings);

}  // namespace catena::haptics
