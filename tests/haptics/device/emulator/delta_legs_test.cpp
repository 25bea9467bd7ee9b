// SPDX-License-Identifier: MIT
/// The emulator's mechanism against golden values of the device. The driver's kinematics are tested against the same values.
#include "haptics/device/emulator/emulated_mechanism.h"

#include <gtest/gtest.h>

#include <glm/matrix.hpp>
#include <limits>
#include <numbers>

namespace catena::haptics::delta_legs_test {

Vec3 counts_at(const Vec3& p_mm) {
  const auto legs = solve_delta_legs(p_mm * 1e-3);
  EXPECT_TRUE(legs.has_value());
  return legs ? angles_to_counts(legs->theta) : Vec3(0.0);
}

void expect_counts(const Vec3& p_mm, const Vec3& counts, double tolerance) {
  const Vec3 at = counts_at(p_mm);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(at[i], counts[i], tolerance) << i;
}

TEST(DeltaLegs, GoldenPositionsGiveTheGoldenEncoders) {
  expect_counts({0, 0, 134.60243}, {0, 0, 0}, 1e-3);
  expect_counts({0, 0, 110.7545}, {-500, -500, -500}, 2e-3);
  expect_counts({-1.49499, -6.69457, 124.77869}, {-100, -200, -300}, 1e-3);
  expect_counts({20, 0, 110}, {-351.36, -856.23, -209.63}, 0.01);
}

TEST(DeltaLegs, AtTheMiddleCountLengthAndTorquePerNewtonAreGolden) {
  const auto legs = *solve_delta_legs({0, 0, 0.11});
  const double count_rad = kEmulatedDegreesPerCount * std::numbers::pi / 180;
  const Mat3 p_by_theta = glm::inverse(legs.dtheta_dp);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(norm(p_by_theta[i]) * count_rad, 37.7e-6, 0.05e-6);
    EXPECT_NEAR(p_by_theta[i].z, 24.18e-3, 0.01e-3);
  }
  // tau = J^T F: the motor counts of 1 N along z give 1 N
  const Vec3 force = compute_motor_force(legs, {-242, -242, -242});
  EXPECT_NEAR(force.z, 242e-4 / 24.18e-3, 1e-3);
  EXPECT_NEAR(force.x, 0, 1e-9);
}

TEST(DeltaLegs, TheJacobianMatchesFiniteDifferences) {
  for (const Vec3& p : {Vec3(0.01, -0.02, 0.1), Vec3(0.03, 0.03, 0.15), Vec3(-0.025, 0.01, 0.095)}) {
    const auto legs = *solve_delta_legs(p);
    for (int j = 0; j < 3; ++j) {
      Vec3 step(0.0);
      step[j] = 1e-6;
      const Vec3 slope = (solve_delta_legs(p + step)->theta - solve_delta_legs(p - step)->theta) / 2e-6;
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(legs.dtheta_dp[j][i], slope[i], 1e-6) << i << j;
    }
  }
}

TEST(DeltaLegs, OutOfReachIsRefused) {
  EXPECT_FALSE(solve_delta_legs({0, 0, 0.19}));
  EXPECT_FALSE(solve_delta_legs({0.12, 0, 0.11}));
  EXPECT_TRUE(solve_delta_legs({0.027, 0, 0.170}));
  EXPECT_FALSE(solve_delta_legs({0, 0, std::numeric_limits<double>::quiet_NaN()}));
}

}  // namespace catena::haptics::delta_legs_test
