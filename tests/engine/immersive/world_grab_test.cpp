/// The world in the hand: what is held stays where it is held, with one hand and two.
#include "engine/immersive/world_grab.h"

#include <gtest/gtest.h>

#include <random>

namespace world_grab_test {

using namespace catena;
using namespace catena::immersive;

const Placement kSome{{2, 11, -6}, glm::mat3_cast(rotation_of({0.3, -1.1, 0.4})), 0.05};

struct Dice {
  std::mt19937 engine{7};
  Vec3 vec(double size) {
    std::uniform_real_distribution<double> d(-size, size);
    return {d(engine), d(engine), d(engine)};
  }
  Hand hand() { return {vec(0.5) + Vec3(0, 1.2, 0), rotation_of(vec(1.5)), true}; }
};

Vec3 turn_between(const Placement& before, const Placement& now) {
  return rotation_vector(normalised(glm::quat_cast(transpose(now.world_from_room) * before.world_from_room)));
}

TEST(Placement, WorldAndRoomLeadBack) {
  Dice dice;
  for (int i = 0; i < 100; ++i) {
    const Vec3 world = dice.vec(20);
    EXPECT_LT(norm(kSome.to_world(kSome.to_room(world)) - world), 1e-13);
    const Vec3 from = dice.vec(1), to = dice.vec(1), room = dice.vec(2);
    const Quat turn = rotation_of(dice.vec(1));
    const Placement after = moved(kSome, from, turn, 1.7, to);
    EXPECT_LT(norm(after.to_room(kSome.to_world(room)) - to - 1.7 * rotate(turn, room - from)), 1e-13);
  }
}

TEST(WorldGrab, OneHandKeepsWhatItHolds) {
  Dice dice;
  for (int i = 0; i < 50; ++i) {
    WorldGrab grab;
    std::array<Hand, 2> hands{};
    const std::size_t which = static_cast<std::size_t>(i % 2);
    const Hand start = hands[which] = dice.hand();
    Placement now = grab.move(kSome, hands);
    EXPECT_EQ(now.world_origin, kSome.world_origin) << "taking hold moves nothing";
    // a point that the hand sees at `seen` of its own axes is seen there ever after
    const Vec3 seen = dice.vec(0.2), world = now.to_world(start.position_m + rotate(start.orientation, seen));
    for (int k = 0; k < 5; ++k) {
      hands[which] = dice.hand();
      now = grab.move(now, hands);
      EXPECT_EQ(now.metres_per_unit, kSome.metres_per_unit);
      EXPECT_LT(norm(now.to_room(world) - hands[which].position_m - rotate(hands[which].orientation, seen)), 1e-13);
    }
  }
}

TEST(WorldGrab, TwoHandsHoldTwoPlaces) {
  Dice dice;
  for (int i = 0; i < 50; ++i) {
    WorldGrab grab;
    std::array<Hand, 2> hands{dice.hand(), dice.hand()};
    Placement now = grab.move(kSome, hands);
    const Vec3 a = now.to_world(hands[0].position_m), b = now.to_world(hands[1].position_m);
    const double span = norm(hands[1].position_m - hands[0].position_m);
    hands = {dice.hand(), dice.hand()};
    now = grab.move(now, hands);
    EXPECT_LT(norm(now.to_room(a) - hands[0].position_m), 1e-12);
    EXPECT_LT(norm(now.to_room(b) - hands[1].position_m), 1e-12);
    EXPECT_NEAR(now.metres_per_unit / kSome.metres_per_unit, norm(hands[1].position_m - hands[0].position_m) / span, 1e-12);
  }
}

TEST(WorldGrab, BothHandsTwistingTogetherTurnTheWorldAboutTheirLine) {
  WorldGrab grab;
  std::array<Hand, 2> hands{Hand{{-0.2, 1, 0}, kNoRotation, true}, Hand{{0.2, 1, 0}, kNoRotation, true}};
  Placement now = grab.move(kSome, hands);
  hands[0].orientation = rotation_of({0.5, 0, 0});
  hands[1].orientation = rotation_of({0.7, 0, 0});
  now = grab.move(now, hands);
  EXPECT_LT(norm(turn_between(kSome, now) - Vec3(0.6, 0, 0)), 1e-12);
}

TEST(WorldGrab, ChangingHandsNeverJumps) {
  Dice dice;
  WorldGrab grab;
  std::array<Hand, 2> hands{dice.hand(), dice.hand()};
  Placement now = kSome;
  const Vec3 world(1, 2, 3);
  for (int k = 0; k < 200; ++k) {
    hands[0].holds = (k / 7) % 2 == 0;
    hands[1].holds = (k / 5) % 3 != 0;
    const bool changes = hands[0].holds != ((k - 1) / 7 % 2 == 0) || hands[1].holds != ((k - 1) / 5 % 3 != 0);
    const Vec3 before = now.to_room(world);
    // the hands move a little in each step: what they carry moves a little too
    for (Hand& hand : hands) {
      hand.position_m += dice.vec(1e-3);
      hand.orientation = normalised(rotation_of(dice.vec(1e-3)) * hand.orientation);
    }
    now = grab.move(now, hands);
    const double moved = norm(now.to_room(world) - before);
    EXPECT_LT(moved, 0.02);
    EXPECT_TRUE(!changes || k == 0 || moved == 0) << k;
    if (k == 60) hands[0].position_m = Vec3(NAN);
    if (k == 61) hands[0].position_m = Vec3(0.1, 1, 0);
  }
}

TEST(WorldGrab, HandsThatTouchDoNotScaleAndTheScaleHasEnds) {
  WorldGrab grab(WorldGrab::Options{.least_metres_per_unit = 0.04, .most_metres_per_unit = 0.06});
  std::array<Hand, 2> hands{Hand{{0, 1, 0}, kNoRotation, true}, Hand{{0.3, 1, 0}, kNoRotation, true}};
  Placement now = grab.move(kSome, hands);
  hands[1].position_m.x = 0.01;
  now = grab.move(now, hands);
  EXPECT_NEAR(now.metres_per_unit, 0.05, 1e-15);
  hands[1].position_m.x = 3;
  now = grab.move(now, hands);
  EXPECT_NEAR(now.metres_per_unit, 0.06, 1e-15);
  hands[1].position_m.x = 0.03;
  now = grab.move(now, hands);
  EXPECT_NEAR(now.metres_per_unit, 0.04, 1e-15);
  EXPECT_LT(norm(turn_between(kSome, now)), 1e-12);
}

TEST(WorldGrab, UprightTurnsAboutTheVerticalAlone) {
  WorldGrab grab(WorldGrab::Options{.upright = true});
  std::array<Hand, 2> hands{Hand{{0, 1, 0}, kNoRotation, true}, Hand{}};
  Placement upright;
  upright.world_from_room = Mat3(Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0, -1, 0));  // z of the world is up
  Placement now = grab.move(upright, hands);
  hands[0].orientation = rotation_of({0.4, 0.9, -0.2});
  now = grab.move(now, hands);
  EXPECT_LT(norm(now.world_from_room * Vec3(0, 1, 0) - Vec3(0, 0, 1)), 1e-12);
  EXPECT_GT(norm(turn_between(upright, now)), 0.5);
}

TEST(Placement, ScaleIsSaidInAUnitThatAPersonReads) {
  EXPECT_EQ(scale_words(0.05), "1 unit = 5 cm");
  EXPECT_EQ(scale_words(1), "1 unit = 1 m");
  EXPECT_EQ(scale_words(0.001), "1 unit = 1 mm");
  EXPECT_EQ(scale_words(2.5e-7), "1 unit = 0.25 um");
  EXPECT_EQ(scale_words(12345), "1 unit = 12.3 km");
}

}  // namespace world_grab_test
