// SPDX-License-Identifier: MIT
#include "haptics/device/usb/falcon_kinematics.h"

#include <gtest/gtest.h>

#include <glm/matrix.hpp>
#include <limits>
#include <numbers>

namespace catena::haptics::usb::falcon_kinematics_test {

constexpr double kPi = std::numbers::pi;

Vec3 forward_mm(const FalconCounts& counts) {
  Vec3 p(0.0);
  EXPECT_TRUE(falcon_forward_kinematics(falcon_angles(counts), p));
  return p * 1e3;
}

struct Legs {
  Vec3 angles{0.0};
  Mat3 jacobian{0.0};
};

Legs legs_at(const Vec3& p) {
  Legs at;
  EXPECT_TRUE(falcon_inverse_kinematics(p, at.angles)) << p.x << " " << p.y << " " << p.z;
  EXPECT_TRUE(falcon_jacobian(p, at.angles, at.jacobian)) << p.x << " " << p.y << " " << p.z;
  return at;
}

// calls f on a grid over the workspace: radius 83 mm up to z = 110 mm, 28 mm at 170 mm
template <class F>
void everywhere(F f) {
  for (double z = 0.075; z <= 0.1751; z += 0.005) {
    const double radius = z < 0.11 ? 0.083 : 0.083 - (z - 0.11) * (0.055 / 0.06);
    for (double x = -0.085; x <= 0.085; x += 0.005)
      for (double y = -0.085; y <= 0.085; y += 0.005)
        if (std::hypot(x, y) <= radius) f(Vec3{x, y, z});
  }
}

TEST(FalconKinematics, ForwardGivesTheGoldenPositions) {
  constexpr double kRead = 1e-5;  // mm, the precision of the reference values
  EXPECT_LT(max_abs(forward_mm({0, 0, 0}) - Vec3(0, 0, 134.60243)), kRead);
  EXPECT_LT(max_abs(forward_mm({-500, -500, -500}) - Vec3(0, 0, 110.75447)), kRead);
  EXPECT_LT(max_abs(forward_mm({-100, -200, -300}) - Vec3(-1.49499, -6.69457, 124.77869)), 2 * kRead);
}

TEST(FalconKinematics, InverseGivesTheGoldenCounts) {
  Vec3 angles;
  ASSERT_TRUE(falcon_inverse_kinematics({0.020, 0, 0.110}, angles));
  EXPECT_LT(max_abs(falcon_encoders(angles) - Vec3(-351.36, -856.23, -209.63)), 0.005);
}

TEST(FalconKinematics, GoldenCountAndTorqueAt110Millimetres) {
  const Vec3 p{0, 0, 0.110};
  const Mat3 j = legs_at(p).jacobian;
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(norm(j[axis]) * 0.0364347 * kPi / 180, 37.7e-6, 0.05e-6);
  EXPECT_LT(max_abs(falcon_torque(j, {0, 0, 1}) - Vec3(24.18e-3)), 0.005e-3);
}

TEST(FalconKinematics, RoundTripsOverTheWholeWorkspace) {
  int places = 0;
  everywhere([&](const Vec3& p) {
    Vec3 angles, back;
    ASSERT_TRUE(falcon_inverse_kinematics(p, angles)) << p.x << " " << p.y << " " << p.z;
    ASSERT_TRUE(falcon_forward_kinematics(angles, back)) << p.x << " " << p.y << " " << p.z;
    ASSERT_LT(max_abs(back - p), 2e-12) << p.x << " " << p.y << " " << p.z;
    ++places;
  });
  EXPECT_GT(places, 5000);
}

TEST(FalconKinematics, TheJacobianMatchesFiniteDifferences) {
  everywhere([](const Vec3& p) {
    const auto [angles, j] = legs_at(p);
    constexpr double h = 1e-5;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 up = angles, down = angles, p_up, p_down;
      up[axis] += h;
      down[axis] -= h;
      ASSERT_TRUE(falcon_forward_kinematics(up, p_up) && falcon_forward_kinematics(down, p_down));
      const Vec3 column = (p_up - p_down) / (2 * h);
      ASSERT_LT(max_abs(column - j[axis]), 1e-5 * norm(j[axis])) << p.x << " " << p.y << " " << p.z << " axis " << axis;
    }
  });
}

TEST(FalconKinematics, TorqueAndForceDoTheSameWork) {
  const Vec3 p{0.015, -0.02, 0.12}, force{1.5, -2, 3};
  const auto [angles, j] = legs_at(p);
  Vec3 moved;
  const Vec3 turn{1e-6, -2e-6, 3e-6};
  ASSERT_TRUE(falcon_forward_kinematics(angles + turn, moved));
  EXPECT_NEAR(dot(falcon_torque(j, force), turn), dot(force, moved - p), 1e-11);
}

TEST(FalconKinematics, OutOfReachIsRefusedAndLeavesTheResultUnchanged) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const Vec3& p : {Vec3{0.2, 0, 0.11}, Vec3{0, 0, 0.3}, Vec3{nan, 0, 0.1}, Vec3{0, inf, 0.1}}) {
    Vec3 angles(7.0);
    EXPECT_FALSE(falcon_inverse_kinematics(p, angles));
    EXPECT_EQ(angles, Vec3(7.0));
  }
  for (const Vec3& angles : {Vec3(3.0), Vec3(-3.0), Vec3(nan, 0.5, 0.5), Vec3(0.5, 0.5, inf), Vec3(0.6, -1.5, 2.5)}) {
    Vec3 p(7.0);
    EXPECT_FALSE(falcon_forward_kinematics(angles, p)) << angles.x << " " << angles.y << " " << angles.z;
    EXPECT_EQ(p, Vec3(7.0));
  }
  Mat3 j(7.0);
  EXPECT_FALSE(falcon_jacobian({0.2, 0, 0.11}, Vec3(0.5), j));
  EXPECT_EQ(j, Mat3(7.0));
}

TEST(FalconKinematics, EveryCountGivesAConsistentPositionOrIsRefused) {
  int found = 0, refused = 0;
  for (int a = -32768; a <= 32767; a += 2621)
    for (int b = -2400; b <= 2400; b += 240)
      for (int c = -2400; c <= 2400; c += 240) {
        const FalconCounts counts{static_cast<std::int16_t>(a), static_cast<std::int16_t>(b), static_cast<std::int16_t>(c)};
        Vec3 p, angles;
        if (!falcon_forward_kinematics(falcon_angles(counts), p)) {
          ++refused;
          continue;
        }
        ++found;
        ASSERT_TRUE(falcon_inverse_kinematics(p, angles));
        ASSERT_LE(max_abs(angles - falcon_angles(counts)), 1e-12);
      }
  EXPECT_GT(found, 100);
  EXPECT_GT(refused, 100);
}

TEST(FalconKinematics, MotorCountsAreTorqueTimesGain) {
  // 24.18 mN m per newton: -241.8 counts
  EXPECT_EQ(falcon_motor_counts(Vec3(24.18e-3), 1e4), (FalconCounts{-242, -242, -242}));
  EXPECT_EQ(falcon_motor_counts({0.01, -0.02, 0}, 2e4), (FalconCounts{-200, 400, 0}));
}

TEST(FalconKinematics, ExcessiveTorqueIsScaledInItsDirection) {
  EXPECT_EQ(falcon_motor_counts({0.8190, -0.4095, 0.2048}, 1e4), (FalconCounts{-4095, 2048, -1024}));
  EXPECT_EQ(falcon_motor_counts({0.4095, 0, 0}, 1e4), (FalconCounts{-4095, 0, 0}));
  EXPECT_EQ(falcon_motor_counts({1e300, 1e300, -1e300}, 1e4), (FalconCounts{-4095, -4095, 4095}));
}

// maximum force in the weakest direction: full torque / max_i |row i of (dp/dtheta)^T|
double weakest_force_n(const Vec3& p) {
  const Mat3 j = legs_at(p).jacobian;
  return kFalconFullTorque / kFalconForceGain / std::max({norm(j[0]), norm(j[1]), norm(j[2])});
}

TEST(FalconKinematics, MinimumForceOverAllDirections) {
  EXPECT_NEAR(weakest_force_n({0, 0, 0.125}), 6.1, 0.05);
  for (const double x : {-0.03, 0.0, 0.03})
    for (const double y : {-0.03, 0.0, 0.03})
      for (const double z : {0.095, 0.125, 0.155}) EXPECT_GT(weakest_force_n({x, y, z}), 4.3) << x << " " << y << " " << z;
}

TEST(FalconKinematics, ANonFiniteTorqueGivesZero) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const Vec3& torque : {Vec3{nan, 0, 0}, Vec3{0, inf, 0}, Vec3{0, 0, -inf}, Vec3{1e308, 0, 0}})
    EXPECT_EQ(falcon_motor_counts(torque, 1e4), (FalconCounts{}));
}

}  // namespace catena::haptics::usb::falcon_kinematics_test
