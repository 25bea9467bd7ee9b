#include "haptics/servo/limits_for.h"

namespace catena::haptics {

Mechanics mechanics_of(const DeviceCapabilities& device, const DeviceSettings& settings) {
  Mechanics m = device.mechanics;
  m.mass_kg = settings.mass_kg.value_or(m.mass_kg);
  m.damping_ns_per_m = settings.damping_ns_per_m.value_or(m.damping_ns_per_m);
  m.friction_n = settings.friction_n.value_or(m.friction_n);
  m.encoder_step_m = settings.encoder_step_m.value_or(m.encoder_step_m);
  m.delay_s = settings.delay_s.value_or(m.delay_s);
  return m;
}

Limits limits_for(const DeviceCapabilities& device, const DeviceSettings& settings) {
  Limits limits;
  limits.damping_ns_per_m = mechanics_of(device, settings).damping_ns_per_m;
  if (device.max_force_n > 0) limits.max_force_n = device.max_force_n;
  if (settings.max_force_n) limits.max_force_n = *settings.max_force_n;
  return limits;
}

}  // namespace catena::haptics
