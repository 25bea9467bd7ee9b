// SPDX-License-Identifier: MIT
#include "haptics/servo/device_limits.h"

#include <gtest/gtest.h>

#include "haptics/device/registry.h"

namespace catena::haptics::device_limits_test {

TEST(DeviceLimits, ADeviceWithoutForceOutputHasNoLimits) {
  const DeviceLimits limits = compute_device_limits(nominal_capabilities("null"), {});
  EXPECT_EQ(limits.max_stiffness_n_per_m, DeviceLimits::kUnlimited);
  EXPECT_EQ(limits.max_force_n, DeviceLimits::kUnlimited);
  EXPECT_EQ(limits.slew_n_per_s, DeviceLimits::kUnlimited);
  EXPECT_EQ(limits.ramp_in_s, 0);
  EXPECT_FALSE(limits.passivity_control);
}

TEST(DeviceLimits, TheSimulatedDeviceGetsTheSafeDefaults) {
  DeviceLimits limits = compute_device_limits(nominal_capabilities("simulated"), {});
  EXPECT_DOUBLE_EQ(limits.max_stiffness_n_per_m, 1000);
  EXPECT_EQ(limits.max_force_n, 10);
  EXPECT_EQ(limits.slew_n_per_s, 5000);
  EXPECT_EQ(limits.ramp_in_s, 0.5);
  EXPECT_TRUE(limits.passivity_control);
  EXPECT_EQ(limits.damping_ns_per_m, 0.5);
  DeviceSettings fast;
  fast.rate_hz = 4000;
  limits = compute_device_limits(nominal_capabilities("simulated"), fast);
  EXPECT_DOUBLE_EQ(limits.max_stiffness_n_per_m, 2500) << "f_c / step";
}

TEST(DeviceLimits, TheUsersSettingsOverrideTheDefaults) {
  DeviceSettings s;
  s.damping_ns_per_m = 2;
  s.delay_s = 1.5e-3;
  s.friction_n = 1;
  s.max_force_n = 3;
  s.slew_n_per_s = 7;
  s.ramp_in_s = 0;
  s.passivity_control = false;
  DeviceLimits limits = compute_device_limits(nominal_capabilities("simulated"), s);
  EXPECT_DOUBLE_EQ(limits.max_stiffness_n_per_m, 2 * 2 / (1e-3 + 3e-3));
  EXPECT_EQ(limits.delay_s, 1.5e-3);
  EXPECT_EQ(limits.max_force_n, 3);
  EXPECT_EQ(limits.slew_n_per_s, 7);
  EXPECT_EQ(limits.ramp_in_s, 0);
  EXPECT_FALSE(limits.passivity_control);
  s.stiffness_cap = DeviceSettings::StiffnessCap::none;
  EXPECT_EQ(compute_device_limits(nominal_capabilities("simulated"), s).max_stiffness_n_per_m, DeviceLimits::kUnlimited);
  s.stiffness_cap = DeviceSettings::StiffnessCap::value;
  s.stiffness_cap_n_per_m = 77;
  EXPECT_EQ(compute_device_limits(nominal_capabilities("simulated"), s).max_stiffness_n_per_m, 77);
  EXPECT_EQ(compute_device_limits(nominal_capabilities("null"), s).max_stiffness_n_per_m, 77) << "though it has no force of its own";
}

TEST(DeviceLimits, AScaleChangesTheMechanismAndNotTheDevicesLimit) {
  DeviceSettings s;
  s.scale = 4;
  const Mechanics device = resolve_mechanics(nominal_capabilities("simulated"), {}),
                  hand = resolve_mechanics(nominal_capabilities("simulated"), s);
  EXPECT_DOUBLE_EQ(hand.mass_kg, device.mass_kg / 4);
  EXPECT_DOUBLE_EQ(hand.damping_ns_per_m, device.damping_ns_per_m / 4);
  EXPECT_DOUBLE_EQ(hand.encoder_step_m, 4 * device.encoder_step_m);
  EXPECT_EQ(hand.friction_n, device.friction_n);
  // stiffness K in scaled metres is 4 K at the device
  EXPECT_DOUBLE_EQ(4 * compute_device_limits(nominal_capabilities("simulated"), s).max_stiffness_n_per_m,
                   compute_device_limits(nominal_capabilities("simulated"), {}).max_stiffness_n_per_m);
  // settings of the mechanism are in the device's metres
  s.damping_ns_per_m = 2;
  EXPECT_DOUBLE_EQ(resolve_mechanics(nominal_capabilities("simulated"), s).damping_ns_per_m, 0.5);
}

TEST(DeviceLimits, ADeviceWithTorqueGetsASafeRotationalSpring) {
  const DeviceCapabilities device = nominal_capabilities("simulated-6dof");
  DeviceSettings s;
  s.delay_s = 0.0;
  const DeviceLimits limits = compute_device_limits(device, s);
  EXPECT_EQ(limits.max_torque_nm, device.max_torque_nm);
  EXPECT_DOUBLE_EQ(limits.max_rotational_stiffness_nm_per_rad, 2 * device.mechanics.rotational_damping_nms_per_rad / 1e-3);
  s.stiffness_cap = DeviceSettings::StiffnessCap::none;
  EXPECT_EQ(compute_device_limits(device, s).max_rotational_stiffness_nm_per_rad, DeviceLimits::kUnlimited);
}

}  // namespace catena::haptics::device_limits_test
