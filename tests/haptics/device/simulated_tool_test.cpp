// SPDX-License-Identifier: MIT
/// The simulated 6-DOF device in a closed loop with the rotational chain.
#include "haptics/device/simulated_device.h"

#include <gtest/gtest.h>

#include <numbers>

#include "haptics/device/device.h"
#include "haptics/device/mass_model.h"
#include "tests/haptics/servo/run_servo.h"
#include "tests/support/axis_link.h"

namespace catena::haptics::simulated_tool_test {

SimulatedToolParameters alone() { return {.grip_stiffness_nm_per_rad = 0, .grip_damping_nms_per_rad = 0, .max_torque_nm = 100}; }

/// The closed loop of device and program without the servo's thread.
struct Loop {
  SimulatedTool tool;
  HapticProgram program;
  ChainState state;
  ChainScratch scratch;
  HapticState out;
  std::uint64_t k = 0;
  Loop(const SimulatedToolParameters& parameters, const Quat& target) : tool(std::make_unique<NullDevice>(), {{0, target}}, parameters) {}
  void step() {
    const DeviceInput in = tool.read();
    tick(program, {1e-3 * static_cast<double>(k++), in.position_m, in.buttons, in.orientation}, state, scratch, out);
    tool.write({out.force_n, out.torque_nm});
  }
};

TEST(SimulatedTool, FollowsItsPathAlongTheShorterArc) {
  const Quat a = rotation_from_vector({0, 0, 3.0}), b = rotation_from_vector({0, 0, -3.0});  // 0.28 rad apart across the angle pi
  SimulatedTool tool(std::make_unique<NullDevice>(), {{0, a}, {1, b}}, {});
  EXPECT_TRUE(tool.capabilities().has_orientation);
  double furthest = 0;
  for (int k = 0; k <= 1500; ++k) {
    const Quat q = tool.read().orientation;
    furthest = std::max(furthest, norm(rotation_vector(q * glm::conjugate(rotation_from_vector({0, 0, std::numbers::pi})))));
  }
  EXPECT_LE(furthest, 0.15);
  EXPECT_LE(norm(rotation_vector(tool.orientation() * glm::conjugate(b))), 1e-6);
}

TEST(SimulatedTool, SettlesWhereTheGripBalancesTheAlignment) {
  // the hand's target is rotated by 0.6 rad from the normal: k_h (0.6 - a) = kappa a
  Loop loop({}, rotation_from_vector({0.6, 0, 0}));
  loop.program.links = {test::axis_link("a", {0, 0, 1}, 0.25)};
  for (int k = 0; k < 4000; ++k) loop.step();
  EXPECT_NEAR(rotation_vector(loop.tool.orientation()).x, 0.5 * 0.6 / 0.75, 1e-9);
  EXPECT_NEAR(loop.out.torque_nm.x, -0.25 * 0.4, 1e-9);
  EXPECT_LE(norm(loop.tool.rate_rad_per_s()), 1e-9);
}

TEST(SimulatedTool, AKickDecaysBelowTheDerivedLimitAndGrowsAboveIt) {
  const SimulatedToolParameters parameters = alone();
  const double limit =
      safe_rotational_stiffness(SimulatedTool(std::make_unique<NullDevice>(), {{}}, parameters).capabilities().mechanics, 1e-3);
  EXPECT_DOUBLE_EQ(limit, 1.0);
  const auto growth = [&](double kappa, bool capped) {
    Loop loop(parameters, kIdentityRotation);
    loop.program.links = {test::axis_link("a", {0, 0, 1}, kappa)};
    if (capped) loop.program.limits.max_rotational_stiffness_nm_per_rad = 0.95 * limit;
    loop.tool.set_rate({0.5, 0, 0});
    double early = 0, late = 0;
    for (int k = 0; k < 8000; ++k) {
      loop.step();
      const double angle = norm(rotation_vector(loop.tool.orientation()));
      if (k < 500) early = std::max(early, angle);
      if (k >= 7500) late = std::max(late, angle);
    }
    return late / early;
  };
  EXPECT_LT(growth(0.95 * limit, false), 0.7);
  EXPECT_GT(growth(1.1 * limit, false), 1.5);
  EXPECT_LT(growth(10 * limit, true), 0.7);  // the device's limit caps the stiffness
}

TEST(SimulatedTool, LimitsItsTorque) {
  SimulatedToolParameters p = alone();
  p.max_torque_nm = 0.01;
  p.damping_nms_per_rad = 0;
  SimulatedTool tool(std::make_unique<NullDevice>(), {{}}, p);
  tool.read();
  tool.write({Vec3(0.0), {3, 4, 0}});
  tool.read();
  EXPECT_NEAR(tool.rate_rad_per_s().x, 0.006 * 1e-3 / p.inertia_kg_m2, 1e-12);
  EXPECT_NEAR(tool.rate_rad_per_s().y, 0.008 * 1e-3 / p.inertia_kg_m2, 1e-12);
  tool.write({Vec3(0.0), Vec3(std::nan(""))});
  const Vec3 before = tool.rate_rad_per_s();
  tool.read();
  EXPECT_EQ(tool.rate_rad_per_s(), before);
}

TEST(SimulatedTool, TheServoRotatesOrientationAndTorqueWithTheWorkspace) {
  // the closed loop in a rotated workspace: the tool ends at the same orientation in device axes
  const auto end = [](const Quat& r) {
    auto program = std::make_shared<HapticProgram>();
    program->links = {test::axis_link("a", rotate(r, {0, 0, 1}), 0.25)};
    program->workspace_rotation = glm::mat3_cast(r);
    SimulatedTool tool(std::make_unique<NullDevice>(), {{0, rotation_from_vector({0.6, 0.1, 0})}}, {});
    Servo servo(tool, program, {.paced = false, .max_ticks = 3000});
    test::run_to_end(servo);
    return tool.orientation();
  };
  const Quat plain = end(kIdentityRotation), turned = end(rotation_from_vector({0.4, -0.9, 1.3}));
  EXPECT_LE(norm(rotation_vector(turned * glm::conjugate(plain))), 1e-9);
  EXPECT_GT(norm(rotation_vector(plain)), 0.3);
}

TEST(SimulatedTool, IsRepeatableBitForBit) {
  const auto run = [] {
    Loop loop({}, rotation_from_vector({0.6, -0.2, 0.1}));
    loop.program.links = {test::axis_link("a", {0.1, 0, 1}, 0.25)};
    for (int k = 0; k < 500; ++k) loop.step();
    return loop.tool.orientation();
  };
  EXPECT_EQ(run(), run());
}

}  // namespace catena::haptics::simulated_tool_test
