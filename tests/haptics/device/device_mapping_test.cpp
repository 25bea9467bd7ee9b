// SPDX-License-Identifier: MIT
#include "haptics/device/device_mapping.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "engine/base/memory_limit.h"
#include "haptics/device/registry.h"
#include "tests/haptics/device/scripted_device.h"

namespace catena::haptics::device_mapping_test {

// hand x = device z, hand y = -device x, hand z = -device y
const Mat3 kAxes(Vec3(0, -1, 0), Vec3(0, 0, -1), Vec3(1, 0, 0));

/// The settings of a mapping.
struct Mapping {
  Mat3 workspace_from_device{1.0};
  double scale = 1;
  int clutch_button = 0, force_button = 0;
  Vec3 gravity_n{0.0};
  DeviceSettings settings() const {
    DeviceSettings s;
    std::tie(s.workspace_from_device, s.scale, s.clutch_button, s.force_button, s.gravity_n) =
        std::tie(workspace_from_device, scale, clutch_button, force_button, gravity_n);
    return s;
  }
};

struct Mapped {
  test::ScriptedDevice* device;
  std::unique_ptr<MappedDevice> map;
  explicit Mapped(const Mapping& mapping, bool oriented = true) {
    auto made = std::make_unique<test::ScriptedDevice>();
    device = made.get();
    device->caps.has_orientation = oriented;
    device->caps.mechanics = {0.2, 0.4, 0.1, 5e-5, 1e-3, 0};
    device->caps.workspace_center_m = {0.01, 0.02, 0.03};
    map = std::make_unique<MappedDevice>(std::move(made), mapping.settings());
  }
  DeviceInput at(const Vec3& p, std::uint32_t buttons = 0, const Quat& q = kIdentityRotation) {
    device->input.position_m = p;
    device->input.orientation = q;
    device->input.buttons = buttons;
    return map->read();
  }
  Vec3 force(const Vec3& f, const Vec3& torque = Vec3(0.0), bool live = true) {
    map->write({f, torque, live});
    return device->output.force_n;
  }
};

void expect_near(const Vec3& a, const Vec3& b, double tolerance = 1e-15) {
  EXPECT_LE(norm(a - b), tolerance) << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " " << b.z;
}

TEST(MappedDevice, DefaultSettingsNeedNoMapping) {
  auto made = std::make_unique<test::ScriptedDevice>();
  EXPECT_TRUE(is_identity_mapping(made->caps, DeviceSettings{}));
  const Device* plain = made.get();
  EXPECT_EQ(with_device_mapping(std::move(made), DeviceSettings{}).get(), plain);
  EXPECT_FALSE(is_identity_mapping(DeviceCapabilities{}, Mapping{.scale = 2}.settings()));
  DeviceCapabilities encoded;
  encoded.mechanics.encoder_step_m = 1e-5;
  EXPECT_FALSE(is_identity_mapping(encoded, DeviceSettings{}));
}

TEST(MappedDevice, UnmappedValuesPassUnchangedBitForBit) {
  Mapped run({.clutch_button = 1});
  const double tiny = std::numeric_limits<double>::denorm_min();
  const Vec3 p(-0.0, tiny, 1e300), f(-0.0, -tiny, 7.1), torque(0.1, -0.0, 3);
  const Quat q(0.3, -0.0, 0.7, 0.1);  // not a unit quaternion
  const DeviceInput in = run.at(p, 6, q);
  EXPECT_EQ(std::memcmp(&in.position_m, &p, sizeof p), 0);
  EXPECT_EQ(std::memcmp(&in.orientation, &q, sizeof q), 0);
  EXPECT_EQ(in.buttons, 6u);
  run.map->write({f, torque});
  EXPECT_EQ(std::memcmp(&run.device->output.force_n, &f, sizeof f), 0);
  EXPECT_EQ(std::memcmp(&run.device->output.torque_nm, &torque, sizeof torque), 0);
}

TEST(MappedDevice, AxesRotateThePoseAndInverselyTheForce) {
  Mapped run({.workspace_from_device = kAxes});
  const Quat tool = rotation_from_vector({0.3, -0.2, 0.5});
  const DeviceInput in = run.at({1, 2, 3}, 0, tool);
  expect_near(in.position_m, {3, -1, -2});
  for (const Vec3& v : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) expect_near(rotate(in.orientation, v), kAxes * rotate(tool, v));
  run.map->write({{1, 2, 3}, {4, 5, 6}});
  expect_near(run.device->output.force_n, {-2, -3, 1});
  expect_near(run.device->output.torque_nm, {-5, -6, 4});
  expect_near(run.map->capabilities().workspace_center_m, {0.03, -0.01, -0.02});
  // virtual work: F . dx is the same on both sides
  EXPECT_NEAR(dot(Vec3(1, 2, 3), in.position_m), dot(run.device->output.force_n, Vec3(1, 2, 3)), 1e-15);
}

TEST(MappedDevice, ADeviceWithoutOrientationStaysWithoutOne) {
  Mapped run({.workspace_from_device = kAxes, .clutch_button = 1}, false);
  EXPECT_EQ(run.at({1, 2, 3}).orientation, kIdentityRotation);
  run.at({1, 2, 4}, 1);
  EXPECT_EQ(run.at({1, 2, 5}).orientation, kIdentityRotation);
}

TEST(MappedDevice, ScaleKeepsTheForceAndScalesTheWorkspace) {
  Mapped run({.scale = 4});
  expect_near(run.at({0.01, 0, 0}).position_m, {0.04, 0, 0});
  expect_near(run.force({1, 0, 0}), {1, 0, 0});
  EXPECT_EQ(run.map->capabilities().workspace_m, 4 * run.device->caps.workspace_m);
}

TEST(MappedDevice, TheClutchHoldsTheProbeAndKeepsTheOffset) {
  Mapped run({.scale = 2, .clutch_button = 2});
  const Quat a = rotation_from_vector({0, 0, 0.5}), b = rotation_from_vector({0.3, 0, 0.2});
  run.at({0.1, 0, 0}, 0, a);
  for (const double x : {0.1, 0.05, -0.2}) {
    const DeviceInput in = run.at({x, 0, 0.01}, 3, b);
    expect_near(in.position_m, {0.2, 0, 0});
    EXPECT_EQ(in.orientation, a);
    EXPECT_FALSE(in.forces_on);
    EXPECT_EQ(in.buttons, 1u);  // the clutch button is masked, the others pass
  }
  // after the clutch there is no jump, and the probe moves on from its held position
  DeviceInput in = run.at({-0.2, 0, 0.01}, 0, b);
  expect_near(in.position_m, {0.2, 0, 0});
  expect_near(rotation_vector(in.orientation * glm::conjugate(a)), Vec3(0.0));
  EXPECT_TRUE(in.forces_on);
  in = run.at({-0.1, 0, 0.01}, 0, b);
  expect_near(in.position_m, {0.4, 0, 0}, 1e-15);

  // the torque is rotated back by the clutch's orientation offset, so that the work is equal on both sides
  const Vec3 torque(0.1, 0.2, 0.3), small(1e-6, -2e-6, 3e-6);
  run.map->write({Vec3(0.0), torque});
  const Quat before = run.at({-0.1, 0, 0.01}, 0, b).orientation,
             after = run.at({-0.1, 0, 0.01}, 0, rotation_from_vector(small) * b).orientation;
  EXPECT_NEAR(dot(torque, rotation_vector(after * glm::conjugate(before))), dot(run.device->output.torque_nm, small), 1e-15);
}

TEST(MappedDevice, AClutchHeldAtTheStartHoldsTheFirstPosition) {
  Mapped run({.clutch_button = 1});
  expect_near(run.at({0.3, 0, 0}, 1).position_m, {0.3, 0, 0});
  expect_near(run.at({0.1, 0, 0}, 1).position_m, {0.3, 0, 0});
  expect_near(run.at({0.1, 0, 0}, 0).position_m, {0.3, 0, 0});
}

TEST(MappedDevice, TheForceSwitchIsOffAtTheStartAndAfterALoss) {
  struct Step {
    std::uint32_t pressed;
    bool forces_on;
    const char* why = "";
    DeviceStatus status = DeviceStatus::ready;
  };
  constexpr DeviceStatus lost = DeviceStatus::lost;
  Mapped run({.force_button = 1});
  for (const Step& step :
       {Step{1, false, "a button held from the start is not a press"}, Step{0, false}, Step{1, true},
        Step{1, true, "toggled by the edge, not the level"}, Step{0, true}, Step{2, true}, Step{3, false}, Step{3, false}, Step{0, false},
        Step{1, true}, Step{0, false, "a loss", lost}, Step{0, false}, Step{1, true}, Step{0, true}, Step{0, false, "a loss", lost},
        Step{1, false, "pressed while nobody looked"}, Step{0, false}, Step{1, true}}) {
    SCOPED_TRACE(step.why);
    run.device->input.status = step.status;
    const DeviceInput input = run.at(Vec3(0.0), step.pressed);
    EXPECT_EQ(input.forces_on, step.forces_on);
    EXPECT_EQ(input.buttons, step.pressed & 2u);
    EXPECT_EQ(input.status, step.status);
  }
  run.device->input.forces_on = false;  // the device's own switch also turns the forces off
  EXPECT_FALSE(run.at(Vec3(0.0), 0).forces_on);
}

TEST(MappedDevice, GravityCompensationRampsInAndStopsWithTheForces) {
  // the gravity force is in device axes
  Mapped run({.workspace_from_device = kAxes, .clutch_button = 1, .gravity_n = {0, 0.5, 0}});
  double last = 0;
  for (int k = 1; k <= 100; ++k) {
    run.at(Vec3(0.0));
    const double g = run.force(Vec3(0.0)).y;
    EXPECT_NEAR(g, 0.005 * k, 1e-12);
    EXPECT_GT(g, last);
    last = g;
  }
  run.at(Vec3(0.0));
  expect_near(run.force({1, 0, 0}), {0, 0.5, 1});
  const auto carried = [&] {
    for (int k = 0; k < 100; ++k) {
      run.at(Vec3(0.0));
      run.force(Vec3(0.0));
    }
    return run.device->output.force_n.y > 0.49;
  };
  // the final zero at shutdown is written without a read before it
  EXPECT_EQ(run.force(Vec3(0.0)), Vec3(0.0));
  ASSERT_TRUE(carried());
  run.at(Vec3(0.0));
  EXPECT_EQ(run.force(Vec3(0.0), Vec3(0.0), false), Vec3(0.0));  // forces off or stopped
  ASSERT_TRUE(carried());
  run.at(Vec3(0.0), 1);
  EXPECT_EQ(run.force(Vec3(0.0)), Vec3(0.0));  // clutching
  ASSERT_TRUE(carried());
  run.device->input.status = DeviceStatus::lost;
  run.at(Vec3(0.0));
  EXPECT_EQ(run.force(Vec3(0.0)), Vec3(0.0));
  run.device->input.status = DeviceStatus::ready;
  ASSERT_TRUE(carried());
  run.at(Vec3(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_EQ(run.force(Vec3(0.0)), Vec3(0.0));
}

TEST(MappedDevice, ARecordedPathIsNotMapped) {
  Mapped run({.workspace_from_device = kAxes, .scale = 3});
  run.device->input.is_recorded = true;
  EXPECT_EQ(run.at({1, 2, 3}).position_m, Vec3(1, 2, 3));
}

TEST(MappedDevice, StopReachesTheDevice) {
  Mapped run({.scale = 3});
  run.map->stop();
  EXPECT_TRUE(run.device->stopped);
}

TEST(MappedDevice, AllocatesNothing) {
  Mapped run({.workspace_from_device = kAxes, .scale = 3, .clutch_button = 1, .gravity_n = Vec3(0.1)});
  const AllocationCounter guard;
  for (int k = 0; k < 100; ++k) {
    run.at(Vec3(0.001 * k), static_cast<std::uint32_t>(k / 10) & 1u);
    run.force(Vec3(1.0));
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST(Registry, OpensADeviceWithTheMappingOfItsSettings) {
  const auto mapped = open_device("null", Mapping{.scale = 2}.settings());
  ASSERT_TRUE(mapped);
  EXPECT_EQ((*mapped)->capabilities().workspace_m, 0.4);
}

TEST(Registry, ListsTheDeviceTypes) {
  for (const char* type : {"null", "simulated", "simulated-6dof", "recorded", "mouse", "controller", "spacemouse"}) {
    EXPECT_TRUE(is_device_type(type)) << type;
    EXPECT_NE(device_type_names().find(type), std::string::npos);
    EXPECT_FALSE(nominal_capabilities(type).name.empty());
  }
  const auto list = list_devices();
  ASSERT_GE(list.size(), 6u);
  bool absent = false;
  for (const DeviceInfo& info : list) {
    EXPECT_FALSE(info.detail.empty());
    EXPECT_FALSE(absent && info.available) << "present ones come first: " << info.name;
    absent = absent || !info.available;
  }
  EXPECT_NE(open_device("sextant", {}).error().message.find("simulated-6dof"), std::string::npos);
  EXPECT_NE(open_device("mouse", {}).error().message.find("catena view"), std::string::npos);
  EXPECT_NE(open_device("controller", {}).error().message.find("catena view SCENE --xr"), std::string::npos);
}

}  // namespace catena::haptics::device_mapping_test
