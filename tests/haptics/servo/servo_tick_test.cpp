// SPDX-License-Identifier: MIT
#include "haptics/servo/servo_tick.h"

#include <gtest/gtest.h>

#include "haptics/device/simulated_device.h"
#include "tests/haptics/servo/run_servo.h"
#include "tests/support/simple_links.h"

namespace catena::haptics::servo_tick_test {

std::shared_ptr<HapticProgram> turned_program() {
  auto program = std::make_shared<HapticProgram>();
  program->epoch = 1;
  program->links = {test::hold_height("a", 0.5)};
  program->meters_per_unit = 0.05;
  program->workspace_origin = Vec3(1, -2, 0.5);
  // a quarter of a turn about x
  program->workspace_rotation = Mat3(Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0, -1, 0));
  return program;
}

TEST(ServoTick, MatchesTheServoBitForBit) {
  const auto program = turned_program();
  std::vector<SimulatedDevice::Waypoint> path;
  for (int k = 0; k < 40; ++k) path.push_back({0.05 * k, {0.01 * (k % 5), 0.002 * k, 0.01 * (k % 3)}, 0});
  SimulatedDevice one(path, desktop_device_parameters()), other(path, desktop_device_parameters());
  Servo servo(one, program, {.rate_hz = 1000, .paced = false, .max_ticks = 2000});
  test::run_to_end(servo);

  StateHash hash;
  ServoStepper stepper(other, *program, 1000);
  double max_force_n = 0;
  for (int k = 0; k < 2000; ++k) {
    EXPECT_EQ(stepper.t_s(), k / 1000.0);
    const HapticState& state = stepper.step();
    hash.add(state);
    max_force_n = std::max(max_force_n, norm(state.force_n));
  }
  EXPECT_EQ(hash.value(), servo.state_hash());
  EXPECT_GT(max_force_n, 0.5) << "the hand was pushed";
}

TEST(ServoTick, WorldAndDeviceTransformsRoundTrip) {
  const auto program = turned_program();
  const Vec3 world(0.3, 0.7, -1.1), device = device_from_world(*program, world);
  EXPECT_LT(norm(world_from_device(*program, device) - world), 1e-15);
  EXPECT_LT(norm(world_from_device(*program, Vec3(0.0)) - program->workspace_origin), 1e-15);
  EXPECT_LT(norm(world_from_device(*program, Vec3(0, 0, 0.05)) - program->workspace_origin - Vec3(0, -1, 0)), 1e-15)
      << "the hand's z goes along the world's -y";
}

}  // namespace catena::haptics::servo_tick_test
