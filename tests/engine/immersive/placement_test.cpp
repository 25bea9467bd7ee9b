/// The world in the hand: what is held stays where it is held, with one hand and two.
#include "engine/immersive/placement.h"

#include <gtest/gtest.h>

#include <random>

namespace placement_test {

using namespace catena;
using namespace catena::immersive;

const Placement kSome{0.05, rotation_of({0.3, -1.1, 0.4}), {0.2, 1.1, -0.6}};

struct Dice {
  std::mt19937 engine{7};
  Vec3 vec(double size) {
    std::uniform_real_distribution<double> d(-size, size);
    return {d(engine), d(engine), d(engine)};
  }
  Hand hand() { return {vec(0.5) + Vec3(0, 1.2, 0), rotation_of(vec(1.5)), true}; }
};

TEST(Placement, WorldAndRoomLeadBack) {
  Dice dice;
  for (int i = 0; i < 100; ++i) {
    const Vec3 world = dice.vec(20);
    EXPECT_LT(norm(world_of(kSome, room_of(kSome, world)) - world), 1e-13);
  }
  Bounds box;
  box.add(Vec3(-1, -2, -3));
  box.add(Vec3(3, 6, 2));
  const Placement p = placed(box, 0.8, {0, 1, -0.5});
  EXPECT_DOUBLE_EQ(p.metres_per_unit, 0.1);
  EXPECT_LT(norm(room_of(p, box.centre()) - Vec3(0, 1, -0.5)), 1e-15);
  EXPECT_LT(norm(room_of(p, box.centre() + Vec3(0, 0, 1)) - Vec3(0, 1.1, -0.5)), 1e-15) << "z of the world is up";
  EXPECT_LT(norm(room_of(p, box.centre() + Vec3(0, -1, 0)) - Vec3(0, 1, -0.4)), 1e-15) << "-y of the world is nearer";
}

TEST(WorldGrab, OneHandKeepsWhatItHolds) {
  Dice dice;
  for (int i = 0; i < 50; ++i) {
    WorldGrab grab;
    std::array<Hand, 2> hands{};
    const std::size_t which = static_cast<std::size_t>(i % 2);
    const Hand start = hands[which] = dice.hand();
    Placement now = grab.move(kSome, hands);
    EXPECT_EQ(now.origin_m, kSome.origin_m) << "taking hold moves nothing";
    // a point that the hand sees at `seen` of its own axes is seen there ever after
    const Vec3 seen = dice.vec(0.2), world = world_of(now, start.position_m + rotate(start.orientation, seen));
    for (int k = 0; k < 5; ++k) {
      hands[which] = dice.hand();
      now = grab.move(now, hands);
      EXPECT_EQ(now.metres_per_unit, kSome.metres_per_unit);
      EXPECT_LT(norm(room_of(now, world) - hands[which].position_m - rotate(hands[which].orientation, seen)), 1e-13);
    }
  }
}

TEST(WorldGrab, TwoHandsHoldTwoPlaces) {
  Dice dice;
  for (int i = 0; i < 50; ++i) {
    WorldGrab grab;
    std::array<Hand, 2> hands{dice.hand(), dice.hand()};
    Placement now = grab.move(kSome, hands);
    const Vec3 a = world_of(now, hands[0].position_m), b = world_of(now, hands[1].position_m);
    const double span = norm(hands[1].position_m - hands[0].position_m);
    hands = {dice.hand(), dice.hand()};
    now = grab.move(now, hands);
    EXPECT_LT(norm(room_of(now, a) - hands[0].position_m), 1e-12);
    EXPECT_LT(norm(room_of(now, b) - hands[1].position_m), 1e-12);
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
  EXPECT_LT(norm(rotation_vector(normalised(now.room_from_world * glm::conjugate(kSome.room_from_world))) - Vec3(0.6, 0, 0)), 1e-12);
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
    const Vec3 before = room_of(now, world);
    // the hands move a little in each step: what they carry moves a little too
    for (Hand& hand : hands) {
      hand.position_m += dice.vec(1e-3);
      hand.orientation = normalised(rotation_of(dice.vec(1e-3)) * hand.orientation);
    }
    now = grab.move(now, hands);
    const double moved = norm(room_of(now, world) - before);
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
  EXPECT_EQ(now.metres_per_unit, 0.05);
  hands[1].position_m.x = 3;
  now = grab.move(now, hands);
  EXPECT_EQ(now.metres_per_unit, 0.06);
  hands[1].position_m.x = 0.03;
  now = grab.move(now, hands);
  EXPECT_EQ(now.metres_per_unit, 0.04);
  EXPECT_LT(norm(rotation_vector(normalised(now.room_from_world * glm::conjugate(kSome.room_from_world)))), 1e-12);
}

TEST(WorldGrab, UprightTurnsAboutTheVerticalAlone) {
  WorldGrab grab(WorldGrab::Options{.upright = true});
  std::array<Hand, 2> hands{Hand{{0, 1, 0}, kNoRotation, true}, Hand{}};
  const Placement upright = turned_about(placed({}, 1, {0, 1, 0}), Vec3(0.0), 0.2);
  Placement now = grab.move(upright, hands);
  hands[0].orientation = rotation_of({0.4, 0.9, -0.2});
  now = grab.move(now, hands);
  const Vec3 up = rotate(now.room_from_world, Vec3(0, 0, 1));
  EXPECT_LT(norm(up - Vec3(0, 1, 0)), 1e-12);
  EXPECT_GT(norm(rotate(now.room_from_world, Vec3(1, 0, 0)) - rotate(upright.room_from_world, Vec3(1, 0, 0))), 0.5);
}

TEST(Placement, ScaleIsSaidInAUnitThatAPersonReads) {
  EXPECT_EQ(scale_words(0.05), "1 unit = 5 cm");
  EXPECT_EQ(scale_words(1), "1 unit = 1 m");
  EXPECT_EQ(scale_words(0.001), "1 unit = 1 mm");
  EXPECT_EQ(scale_words(2.5e-7), "1 unit = 0.25 um");
  EXPECT_EQ(scale_words(12345), "1 unit = 12.3 km");
}

}  // namespace placement_test
