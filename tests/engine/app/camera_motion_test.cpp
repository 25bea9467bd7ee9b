// SPDX-License-Identifier: MIT
#include "engine/app/viewer/input/camera_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace catena::app::camera_motion_test {

render::View view() { return {{0.0, -10.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 30, false, 4}; }

TEST(Fly, ManySmallStepsCoverTheDistanceOfOneLargeStep) {
  const FlyKeys keys{.forward = true, .right = true};
  render::View one = view(), many = view();
  Flight f1, f2;
  fly(one, f1, keys, 8, 1, 0.5);
  for (int i = 0; i < 50; ++i) fly(many, f2, keys, 8, 1, 0.01);
  EXPECT_NEAR(norm(one.position - many.position), 0, 1e-12);
  EXPECT_NEAR(norm(f1.velocity - f2.velocity), 0, 1e-12);
  // Two keys are no faster than one, and the target moves with the camera.
  EXPECT_LT(norm(f1.velocity), kFlyDiagonalsPerS * 8);
  EXPECT_NEAR(norm((one.target - one.position) - (view().target - view().position)), 0, 1e-12);
}

TEST(Fly, TheSpeedScalesWithTheSceneAndFastIsFourTimesAsFast) {
  for (const bool fast : {false, true}) {
    const FlyKeys keys{.forward = true, .fast = fast};
    render::View v = view();
    Flight flight;
    fly(v, flight, keys, 8, 1, 1);  // reaches its steady speed
    const double from = v.position.y;
    fly(v, flight, keys, 8, 1, 1);
    EXPECT_NEAR(v.position.y - from, (fast ? 4 : 1) * kFlyDiagonalsPerS * 8, 1e-2);
  }
}

TEST(Fly, TheCameraGlidesToRestWhenTheKeysAreReleased) {
  render::View v = view();
  Flight flight;
  fly(v, flight, {.up = true}, 8, 1, 0.3);
  EXPECT_GT(v.position.z, 0);
  EXPECT_FALSE(flight.is_at_rest(8));
  fly(v, flight, {}, 8, 1, 2);
  EXPECT_TRUE(flight.is_at_rest(8));
  const Vec3 at = v.position;
  fly(v, flight, {}, 8, 1, 0);
  EXPECT_EQ(v.position, at);
}

TEST(Fly, AnOrthographicCameraZoomsInstead) {
  render::View v = view();
  v.orthographic = true;
  Flight flight;
  fly(v, flight, {.forward = true}, 8, 1, 0.5);
  EXPECT_LT(v.height, 4);
  EXPECT_EQ(v.position, view().position);
}

TEST(Fly, LookingAroundRotatesTheTargetAboutTheCamera) {
  render::View v = view();
  look_around(v, 0.5 * std::numbers::pi, 0);
  EXPECT_NEAR(norm(v.target - Vec3(10, -10, 0)), 0, 1e-12) << "to the right";
  EXPECT_EQ(v.position, view().position);
  v = view();
  look_around(v, 0, 0.25 * std::numbers::pi);
  EXPECT_NEAR(norm(v.target - Vec3(0, -10 + 10 * std::sqrt(0.5), 10 * std::sqrt(0.5))), 0, 1e-12) << "up";
  for (int i = 0; i < 100; ++i) look_around(v, 0.1, 0.3);
  EXPECT_TRUE(is_finite(v.target));
  EXPECT_NEAR(norm(v.target - v.position), 10, 1e-9);
  EXPECT_GT(norm(cross(v.target - v.position, v.up)), 0.1) << "short of the pole";
}

TEST(Turntable, CompletesATurnInItsPeriod) {
  render::View v = view();
  const double lap = 2 * std::numbers::pi / kTurntableRadPerS;
  advance_turntable(v, 0.5 * lap);
  EXPECT_NEAR(norm(v.position - Vec3(0, 10, 0)), 0, 1e-9);
  for (int i = 0; i < 50; ++i) advance_turntable(v, 0.01 * lap);
  EXPECT_NEAR(norm(v.position - view().position), 0, 1e-9);
}

}  // namespace catena::app::camera_motion_test
