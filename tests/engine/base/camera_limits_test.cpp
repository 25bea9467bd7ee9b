// SPDX-License-Identifier: MIT
#include "engine/base/camera_limits.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/results.h"

namespace catena::camera_limits_test {

constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(CameraLimits, ReasonableCamerasOfAnyScaleAreValid) {
  for (const double unit : {1e-9, 1e-3, 1.0, 1e6, 1e12})
    EXPECT_EQ(validate_view(Vec3(3, -4, 5) * unit, Vec3(0.1, 0, 0) * unit), "") << unit;
  EXPECT_EQ(validate_view({1e6, 0, 0}, {1e6 + 1, 0, 0}), "") << "an eye far from the origin";
  for (const double fovy : {0.01, 30.0, 170.0}) EXPECT_EQ(validate_fovy(fovy), "");
}

TEST(CameraLimits, ExtremeCamerasAreRefused) {
  for (const double far : {1e16, -1e30, 1e308, kInf, std::nan("")}) {
    EXPECT_TRUE(test::has(validate_view({0, far, 0}, {0, 0, 0}), "too far away")) << far;
    EXPECT_TRUE(test::has(validate_view({0, 1, 0}, {far, 0, 0}), "too far away")) << far;
  }
  EXPECT_TRUE(test::has(validate_view({1, 2, 3}, {1, 2, 3}), "two different points"));
  EXPECT_TRUE(test::has(validate_view({6, 0, 0}, {6.0000000000001, 0, 0}), "two different points"));
  EXPECT_TRUE(test::has(validate_view({0, 0, 0}, {1e-300, 0, 0}), "two different points"));
  for (const double fovy : {0.0, -1.0, 1e-30, 180.0, 179.9999999, kInf, std::nan("")})
    EXPECT_TRUE(test::has(validate_fovy(fovy), "degrees between 0 and 180")) << fovy;
}

}  // namespace catena::camera_limits_test
