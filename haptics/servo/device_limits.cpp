// SPDX-License-Identifier: MIT
#include "haptics/servo/device_limits.h"

#include <algorithm>

#include "haptics/device/mass_model.h"

namespace catena::haptics {

namespace {

constexpr double kRampIn_s = 0.5, kFullForceIn_s = 2e-3, kMaxSlew = 1e4;

}  // namespace

Mechanics resolve_mechanics(const DeviceCapabilities& device, const DeviceSettings& settings) {
  Mechanics m = device.mechanics;
  m.mass_kg = settings.mass_kg.value_or(m.mass_kg);
  m.damping_ns_per_m = settings.damping_ns_per_m.value_or(m.damping_ns_per_m);
  m.friction_n = settings.friction_n.value_or(m.friction_n);
  m.encoder_step_m = settings.encoder_step_m.value_or(m.encoder_step_m);
  m.delay_s = settings.delay_s.value_or(m.delay_s);
  // the device mapping scales lengths but not forces (haptics/device/device_mapping.h)
  m.mass_kg /= settings.scale;
  m.damping_ns_per_m /= settings.scale;
  m.encoder_step_m *= settings.scale;
  return m;
}

double max_added_damping(double mass_kg, double period_s, double delay_s) { return 0.25 * mass_kg / (period_s + delay_s); }

DeviceLimits compute_device_limits(const DeviceCapabilities& device, const DeviceSettings& settings) {
  const Mechanics m = resolve_mechanics(device, settings);
  const double period_s = 1 / settings.rate_hz;
  DeviceLimits limits;
  limits.damping_ns_per_m = m.damping_ns_per_m;
  limits.delay_s = m.delay_s;

  // defaults of a device that outputs force
  if (device.max_force_n > 0) {
    limits.max_force_n = device.max_force_n;
    limits.slew_n_per_s = std::min(device.max_force_n / kFullForceIn_s, kMaxSlew);
    limits.ramp_in_s = kRampIn_s;
    limits.passivity_control = settings.passivity_control;
    limits.max_added_damping_ns_per_m = max_added_damping(m.mass_kg, period_s, m.delay_s);
    if (settings.stiffness_cap == DeviceSettings::StiffnessCap::safe)
      limits.max_stiffness_n_per_m = safe_stiffness(m, period_s).min_n_per_m();
  }
  if (device.max_torque_nm > 0) {
    limits.max_torque_nm = device.max_torque_nm;
    if (settings.stiffness_cap == DeviceSettings::StiffnessCap::safe)
      limits.max_rotational_stiffness_nm_per_rad = safe_rotational_stiffness(m, period_s);
  }

  if (device.has_vibration) limits.ramp_in_s = kRampIn_s;

  // the user's settings
  if (settings.stiffness_cap == DeviceSettings::StiffnessCap::value) limits.max_stiffness_n_per_m = settings.stiffness_cap_n_per_m;
  limits.max_force_n = settings.max_force_n.value_or(limits.max_force_n);
  limits.max_torque_nm = settings.max_torque_nm.value_or(limits.max_torque_nm);
  limits.slew_n_per_s = settings.slew_n_per_s.value_or(limits.slew_n_per_s);
  limits.ramp_in_s = settings.ramp_in_s.value_or(limits.ramp_in_s);
  return limits;
}

}  // namespace catena::haptics
