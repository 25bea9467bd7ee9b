// SPDX-License-Identifier: MIT
#include "haptics/device/simulated_device.h"

#include <gtest/gtest.h>

#include <cmath>

#include "haptics/device/mass_model.h"
#include "haptics/device/registry.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::haptics::simulated_device_test {

SimulatedDeviceParameters bare() { return {.grip_stiffness_n_per_m = 0, .grip_damping_ns_per_m = 0}; }

TEST(Mechanism, OneStepMatchesTheClosedForm) {
  // mass and damper
  const double m = 0.159, b = 0.7, t = 3e-3, e = std::exp(-b * t / m);
  LinearStep s = make_linear_step(m, b, 0, t);
  EXPECT_NEAR(s.v_from_v, e, 1e-15);
  EXPECT_NEAR(s.x_from_v, m / b * (1 - e), 1e-16);
  EXPECT_NEAR(s.v_from_u, (1 - e) / b, 1e-15);
  EXPECT_NEAR(s.x_from_u, (t - m / b * (1 - e)) / b, 1e-16);
  // mass alone
  s = make_linear_step(m, 0, 0, t);
  EXPECT_DOUBLE_EQ(s.x_from_u, 0.5 * t * t / m);
  EXPECT_DOUBLE_EQ(s.v_from_u, t / m);
  // with a spring, over many periods
  const double k = 800, w = std::sqrt(k / m - b * b / (4 * m * m)), d = std::exp(-b * 0.5 / (2 * m));
  s = make_linear_step(m, b, k, 0.5);
  EXPECT_NEAR(s.x_from_v, d * std::sin(w * 0.5) / w, 1e-12);
  EXPECT_NEAR(s.x_from_u, (1 - d * (std::cos(w * 0.5) + b / (2 * m * w) * std::sin(w * 0.5))) / k, 1e-12);
}

TEST(Mechanism, FrictionHoldsAMassAtRestExactly) {
  const LinearStep s = make_linear_step(0.15, 0.5, 300, 1e-3);
  MassState state{{0.1, 0.2, 0.3}, Vec3(0.0)};
  for (int i = 0; i < 1000; ++i) advance_mass(s, {0.06, 0.05, -0.06}, 0.1, state);
  EXPECT_EQ(state.position_m, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(state.velocity_m_per_s, Vec3(0.0));
  advance_mass(s, {0.07, 0.05, -0.06}, 0.1, state);
  EXPECT_GT(norm(state.velocity_m_per_s), 0);
}

TEST(Mechanism, FrictionStopsASlidingMassAtTheExactDistance) {
  // m v^2 / 2 = f_c x, in any direction
  for (const Vec3& way : {Vec3(1, 0, 0), Vec3(0.6, 0, -0.8)}) {
    const LinearStep s = make_linear_step(0.2, 0, 0, 1e-4);
    MassState state{Vec3(0.0), way * 0.3};
    int steps = 0;
    while (norm(state.velocity_m_per_s) > 0 && ++steps < 100000) advance_mass(s, Vec3(0.0), 0.5, state);
    EXPECT_NEAR(norm(state.position_m), 0.2 * 0.09 / 2 / 0.5, 1e-7);
    EXPECT_NEAR(steps * 1e-4, 0.2 * 0.3 / 0.5, 1.01e-4);
    EXPECT_NEAR(norm(cross(state.position_m, way)), 0, 1e-12);
  }
}

TEST(SimulatedDevice, AHeldForceGivesTheExactSampledSystem) {
  SimulatedDeviceParameters p = bare();
  p.device_damping_ns_per_m = 2;
  SimulatedDevice hand({{}}, p);
  for (int k = 0; k < 200; ++k) {
    const double t = k * p.period_s, tau = p.mass_kg / 2;
    ASSERT_NEAR(hand.read().position_m.x, 0.6 / 2 * (t - tau * (1 - std::exp(-t / tau))), 1e-14) << k;
    hand.write({{0.6, 0, 0}, Vec3(0.0)});
  }
}

TEST(SimulatedDevice, ADelayMayBeFractionalPeriods) {
  for (const double delay : {0.0, 0.4, 1.0, 2.7, 62.0}) {
    SimulatedDeviceParameters p = bare();
    p.delay_s = delay * 1e-3;
    SimulatedDevice hand({{}}, p);
    for (int k = 0; k < 100; ++k) {
      const double t = std::fmax(0.0, (k - delay) * 1e-3);
      ASSERT_NEAR(hand.read().position_m.x, 0.5 * (0.3 / p.mass_kg) * t * t, 1e-14) << delay << " " << k;
      hand.write({{0.3, 0, 0}, Vec3(0.0)});
    }
  }
}

TEST(SimulatedDevice, MotorsSaturateAndEncodersRound) {
  SimulatedDeviceParameters p = bare();
  p.max_force_n = 1;
  p.encoder_step_m = 1e-4;
  SimulatedDevice hand({{}}, p), free({{}}, bare());
  int steps = 0;
  double last = 0;
  for (int k = 0; k < 50; ++k) {
    const double x = hand.read().position_m.x, exact = free.read().position_m.x;
    ASSERT_LE(std::fabs(x - exact), 0.5e-4 + 1e-12);
    ASSERT_NEAR(x, 1e-4 * std::round(x / 1e-4), 1e-15);
    steps += x != last;
    last = x;
    hand.write({{100, 0, 0}, Vec3(0.0)});
    free.write({{1, 0, 0}, Vec3(0.0)});
  }
  EXPECT_GT(steps, 10);
}

TEST(SimulatedDevice, TremorHasTheStatedAmplitudeAndIsRepeatable) {
  // a stiff grip, so that the pose equals the target
  const SimulatedDeviceParameters p{.grip_stiffness_n_per_m = 1e6, .grip_damping_ns_per_m = 800, .tremor_m = 3e-4};
  SimulatedDevice a({{}}, p), b({{}}, p);
  double sum = 0;
  for (int k = 0; k < 20000; ++k) {
    const Vec3 x = a.read().position_m;
    ASSERT_EQ(x, b.read().position_m);
    sum += x.y * x.y;
    a.write({});
    b.write({});
  }
  EXPECT_NEAR(std::sqrt(sum / 20000), 3e-4, 1e-5);
}

TEST(SimulatedDevice, AMassSticksUntilTheForceExceedsTheFriction) {
  // the grip's spring force rises slowly: the mass sticks until k_h x = f_c
  SimulatedDevice hand({{0, Vec3(0.0)}, {1, {0.01, 0, 0}}}, {.grip_stiffness_n_per_m = 200, .grip_damping_ns_per_m = 0, .friction_n = 0.5});
  double left_at = 0;
  for (int k = 0; k < 1000 && left_at == 0; ++k) {
    if (hand.read().position_m.x > 0) left_at = 1e-3 * k;
    hand.write({});
  }
  EXPECT_NEAR(left_at, 0.25, 2e-3);
}

TEST(SafeStiffness, IsTheSmallerOfTheTwoBounds) {
  Mechanics m;
  m.damping_ns_per_m = 0.5;
  EXPECT_DOUBLE_EQ(safe_stiffness(m, 1e-3).min_n_per_m(), 1000);
  EXPECT_DOUBLE_EQ(safe_stiffness(m, 0.25e-3).min_n_per_m(), 4000);
  m.delay_s = 1e-3;
  EXPECT_NEAR(safe_stiffness(m, 1e-3).min_n_per_m(), 1000 / 3.0, 1e-9);
  m.delay_s = 0;
  m.encoder_step_m = 4e-5;
  m.friction_n = 0.01;
  EXPECT_DOUBLE_EQ(safe_stiffness(m, 1e-3).min_n_per_m(), 250);
  m.friction_n = 0;
  EXPECT_EQ(safe_stiffness(m, 1e-3).min_n_per_m(), 0);
  EXPECT_NE(describe_safe_stiffness(m, 1e-3).find("without friction"), std::string::npos);
  m = {};
  EXPECT_EQ(safe_stiffness(m, 1e-3).min_n_per_m(), 0);
  EXPECT_NE(describe_safe_stiffness(m, 1e-3).find("without damping"), std::string::npos);
}

TEST(SimulatedDevice, FollowsAPathByName) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "p.csv", "t,x,y,z,buttons\n0,0.01,0,0,0\n0.1,0.03,0,0,2\n");
  const auto device = test::value_of(open_device("simulated:" + (folder / "p.csv"), {}));
  DeviceInput input = device->read();
  EXPECT_NEAR(input.position_m.x, 0.01, 4e-5);
  EXPECT_EQ(input.buttons, 0u);
  for (int k = 0; k < 1000; ++k) {
    input = device->read();
    device->write({});
  }
  EXPECT_NEAR(input.position_m.x, 0.03, 4e-4);
  EXPECT_EQ(input.buttons, 2u);
  EXPECT_EQ(device->capabilities().mechanics.damping_ns_per_m, 0.5);
}

TEST(SimulatedDevice, AMissingPathAndATooLongDelayAreErrors) {
  DeviceSettings settings;
  EXPECT_TRUE(test::fails(open_device("simulated:no/such.csv", settings), "no/such.csv"));
  settings.delay_s = 1;
  EXPECT_TRUE(test::fails(open_device("simulated", settings), "delay"));
}

}  // namespace catena::haptics::simulated_device_test
