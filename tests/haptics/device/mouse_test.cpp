// SPDX-License-Identifier: MIT
#include "haptics/device/mouse.h"

#include <gtest/gtest.h>

#include <cmath>

namespace catena::haptics::mouse_test {

TEST(Mouse, StartsAtTheGivenPosition) {
  MouseDevice mouse({1.0, 2.0, 3.0});
  const DeviceInput input = mouse.read();
  EXPECT_EQ(input.position_m, Vec3(1.0, 2.0, 3.0));
  EXPECT_EQ(input.buttons, 0u);
  EXPECT_EQ(input.status, DeviceStatus::ready);
  EXPECT_FALSE(input.is_recorded);
}

TEST(Mouse, WithoutSmoothingTheNewestPositionIsUsed) {
  MouseDevice mouse(Vec3(0.0), {0, 1000});
  mouse.move_to({1.0, 0.0, 0.0}, 1);
  mouse.move_to({2.0, 0.0, 0.0}, 3);
  EXPECT_EQ(mouse.read().position_m, Vec3(2.0, 0.0, 0.0));
  EXPECT_EQ(mouse.read().buttons, 3u);
}

TEST(Mouse, MotionIsSmoothedByTheTimeConstant) {
  MouseDevice mouse(Vec3(0.0), {0.02, 1000});
  mouse.move_to({1.0, 0.0, 0.0}, 0);
  double last = 0;
  for (int k = 1; k <= 20; ++k) {
    const double x = mouse.read().position_m.x;
    EXPECT_GT(x, last);
    EXPECT_LT(x - last, 0.05);
    last = x;
  }
  EXPECT_NEAR(last, 1 - std::exp(-1), 1e-12);

  // the position comes to rest exactly
  for (int k = 0; k < 1000; ++k) mouse.read();
  EXPECT_EQ(mouse.read().position_m, Vec3(1.0, 0.0, 0.0));
}

TEST(Mouse, ANonFinitePositionIsIgnored) {
  MouseDevice mouse(Vec3(0.0), {0, 1000});
  mouse.move_to({std::nan(""), 0.0, 0.0}, 1);
  EXPECT_EQ(mouse.read().position_m, Vec3(0.0));
}

TEST(Mouse, ARotationIsSmoothedAlongTheShorterArcAndComesToRest) {
  MouseDevice mouse(Vec3(0.0), {0.02, 1000});
  const Quat target = rotation_from_vector({0, 0, 1.0});
  mouse.move_to(Vec3(0.0), 0, Quat(-target.w, -target.x, -target.y, -target.z));  // the same rotation
  double last = 0;
  for (int k = 1; k <= 20; ++k) {
    const double angle = rotation_vector(mouse.read().orientation).z;
    EXPECT_GT(angle, last);
    last = angle;
  }
  EXPECT_NEAR(last, 1 - std::exp(-1), 1e-12);
  for (int k = 0; k < 1000; ++k) mouse.read();
  EXPECT_NEAR(rotation_vector(mouse.read().orientation).z, 1.0, 1e-15);
  mouse.move_to(Vec3(1.0), 0, Quat(std::nan(""), 0, 0, 0));
  for (int k = 0; k < 10; ++k) EXPECT_EQ(mouse.read().position_m, Vec3(0.0));
}

}  // namespace catena::haptics::mouse_test
