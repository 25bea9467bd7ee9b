// SPDX-License-Identifier: MIT
/// Grabbing the world with one hand or two: the grabbed points stay at the hands.
#include "engine/app/viewer/xr/world_grab.h"

#include <gtest/gtest.h>

#include <random>

namespace world_grab_test {

using namespace catena;
using namespace catena::xr_interaction;

const Placement kSome{{2, 11, -6}, glm::mat3_cast(rotation_from_vector({0.3, -1.1, 0.4})), 0.05};

struct Dice {
  std::mt19937 engine{7};
  Vec3 vec(double size) {
    std::uniform_real_distribution<double> d(-size, size);
    return {d(engine), d(engine), d(engine)};
  }
  GrabController hand() { return {vec(0.5) + Vec3(0, 1.2, 0), rotation_from_vector(vec(1.5)), true}; }
};

Vec3 turn_between(const Placement& before, const Placement& now) {
  return rotation_vector(normalized(glm::quat_cast(transpose(now.world_from_room) * before.world_from_room)));
}

TEST(Placement, WorldAndRoomTransformsAreInverse) {
  Dice dice;
  for (int i = 0; i < 100; ++i) {
    const Vec3 world = dice.vec(20);
    EXPECT_LT(norm(kSome.to_world(kSome.to_room(world)) - world), 1e-13);
    const Vec3 from = dice.vec(1), to = dice.vec(1), room = dice.vec(2);
    const Quat turn = rotation_from_vector(dice.vec(1));
    const Placement after = move_world(kSome, from, turn, 1.7, to);
    EXPECT_LT(norm(after.to_room(kSome.to_world(room)) - to - 1.7 * rotate(turn, room - from)), 1e-13);
  }
}

TEST(WorldGrab, OneHandKeepsTheGrabbedPose) {
  Dice dice;
  for (int i = 0; i < 50; ++i) {
    WorldGrab grab;
    std::array<GrabController, 2> hands{};
    const std::size_t which = static_cast<std::size_t>(i % 2);
    const GrabController start = hands[which] = dice.hand();
    Placement now = grab.move(kSome, hands);
    EXPECT_EQ(now.world_origin, kSome.world_origin) << "taking hold moves nothing";
    // A world point at `hand_point` in the hand's frame stays there.
    const Vec3 hand_point = dice.vec(0.2), world = now.to_world(start.position_m + rotate(start.orientation, hand_point));
    for (int k = 0; k < 5; ++k) {
      hands[which] = dice.hand();
      now = grab.move(now, hands);
      EXPECT_EQ(now.meters_per_unit, kSome.meters_per_unit);
      EXPECT_LT(norm(now.to_room(world) - hands[which].position_m - rotate(hands[which].orientation, hand_point)), 1e-13);
    }
  }
}

TEST(WorldGrab, TwoHandsKeepTwoGrabbedPoints) {
  Dice dice;
  for (int i = 0; i < 50; ++i) {
    WorldGrab grab;
    std::array<GrabController, 2> hands{dice.hand(), dice.hand()};
    Placement now = grab.move(kSome, hands);
    const Vec3 a = now.to_world(hands[0].position_m), b = now.to_world(hands[1].position_m);
    const double span = norm(hands[1].position_m - hands[0].position_m);
    hands = {dice.hand(), dice.hand()};
    now = grab.move(now, hands);
    EXPECT_LT(norm(now.to_room(a) - hands[0].position_m), 1e-12);
    EXPECT_LT(norm(now.to_room(b) - hands[1].position_m), 1e-12);
    EXPECT_NEAR(now.meters_per_unit / kSome.meters_per_unit, norm(hands[1].position_m - hands[0].position_m) / span, 1e-12);
  }
}

TEST(WorldGrab, TwistingBothHandsRotatesTheWorldAboutTheirLine) {
  WorldGrab grab;
  std::array<GrabController, 2> hands{GrabController{{-0.2, 1, 0}, kIdentityRotation, true},
                                      GrabController{{0.2, 1, 0}, kIdentityRotation, true}};
  Placement now = grab.move(kSome, hands);
  hands[0].orientation = rotation_from_vector({0.5, 0, 0});
  hands[1].orientation = rotation_from_vector({0.7, 0, 0});
  now = grab.move(now, hands);
  EXPECT_LT(norm(turn_between(kSome, now) - Vec3(0.6, 0, 0)), 1e-12);
}

TEST(WorldGrab, ChangingTheGrabbingHandsCausesNoJump) {
  Dice dice;
  WorldGrab grab;
  std::array<GrabController, 2> hands{dice.hand(), dice.hand()};
  Placement now = kSome;
  const Vec3 world(1, 2, 3);
  for (int k = 0; k < 200; ++k) {
    hands[0].is_grabbing = (k / 7) % 2 == 0;
    hands[1].is_grabbing = (k / 5) % 3 != 0;
    const bool changes = hands[0].is_grabbing != ((k - 1) / 7 % 2 == 0) || hands[1].is_grabbing != ((k - 1) / 5 % 3 != 0);
    const Vec3 before = now.to_room(world);
    // The hands move a little in each step, so the world moves a little.
    for (GrabController& hand : hands) {
      hand.position_m += dice.vec(1e-3);
      hand.orientation = normalized(rotation_from_vector(dice.vec(1e-3)) * hand.orientation);
    }
    now = grab.move(now, hands);
    const double moved = norm(now.to_room(world) - before);
    EXPECT_LT(moved, 0.02);
    EXPECT_TRUE(!changes || k == 0 || moved == 0) << k;
    if (k == 60) hands[0].position_m = Vec3(NAN);
    if (k == 61) hands[0].position_m = Vec3(0.1, 1, 0);
  }
}

TEST(WorldGrab, HandsThatAreTooCloseDoNotScaleAndTheScaleIsLimited) {
  WorldGrab grab(WorldGrab::Options{.min_meters_per_unit = 0.04, .max_meters_per_unit = 0.06});
  std::array<GrabController, 2> hands{GrabController{{0, 1, 0}, kIdentityRotation, true},
                                      GrabController{{0.3, 1, 0}, kIdentityRotation, true}};
  Placement now = grab.move(kSome, hands);
  hands[1].position_m.x = 0.01;
  now = grab.move(now, hands);
  EXPECT_NEAR(now.meters_per_unit, 0.05, 1e-15);
  hands[1].position_m.x = 3;
  now = grab.move(now, hands);
  EXPECT_NEAR(now.meters_per_unit, 0.06, 1e-15);
  hands[1].position_m.x = 0.03;
  now = grab.move(now, hands);
  EXPECT_NEAR(now.meters_per_unit, 0.04, 1e-15);
  EXPECT_LT(norm(turn_between(kSome, now)), 1e-12);
}

TEST(WorldGrab, YawOnlyRotatesAboutTheVerticalOnly) {
  WorldGrab grab(WorldGrab::Options{.yaw_only = true});
  std::array<GrabController, 2> hands{GrabController{{0, 1, 0}, kIdentityRotation, true}, GrabController{}};
  Placement upright;
  upright.world_from_room = Mat3(Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0, -1, 0));  // z of the world is up
  Placement now = grab.move(upright, hands);
  hands[0].orientation = rotation_from_vector({0.4, 0.9, -0.2});
  now = grab.move(now, hands);
  EXPECT_LT(norm(now.world_from_room * Vec3(0, 1, 0) - Vec3(0, 0, 1)), 1e-12);
  EXPECT_GT(norm(turn_between(upright, now)), 0.5);
}

TEST(Placement, TheScaleIsFormattedInAReadableUnit) {
  EXPECT_EQ(format_scale(0.05), "1 unit = 5 cm");
  EXPECT_EQ(format_scale(1), "1 unit = 1 m");
  EXPECT_EQ(format_scale(0.001), "1 unit = 1 mm");
  EXPECT_EQ(format_scale(2.5e-7), "1 unit = 0.25 um");
  EXPECT_EQ(format_scale(12345), "1 unit = 12.3 km");
}

}  // namespace world_grab_test
