// SPDX-License-Identifier: MIT
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::plane_test {

const std::string kFloor = R"({"name": "a", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 5])";

TEST(Plane, ProjectsOrthogonally) {
  Rig rig(build(R"({"name": "a", "type": "plane", "point": [1, 2, 3], "normal": [1, 2, -2]})"));
  Random random(1);
  const Vec3 n = Vec3(1, 2, -2) / 3.0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 probe = random.box(10);
    EXPECT_LE(std::fabs(dot(n, rig.tick(probe).proxy - Vec3(1, 2, 3))), 1e-14 * 10);
    EXPECT_LE(norm(cross(n, probe - rig.state.proxy)), 1e-14 * 10);
    EXPECT_EQ(rig.state.status, LinkStatus::ok);
  }
}

TEST(Plane, IsFreeAboveAndHeldBelow) {
  Rig rig(build(kFloor + R"(, "free": "above"})"));
  expect_steps(rig, {{{0.1, 0.2, 0.3}, kFree, {0.1, 0.2, 0.3}}});
  EXPECT_TRUE(rig.state.active());
  expect_steps(rig, {{{0.1, 0.2, -0.3}, kOk, {0.1, 0.2, 0}},  // within the tick of the crossing
                     {{0.1, 0.2, 1e-9}, kFree}});
}

TEST(Plane, IsFreeBelow) {
  Rig rig(build(kFloor + R"(, "free": "below"})"));
  expect_steps(rig, {{{0, 0, -1}, kFree}, {{0, 0, 1}, kOk}});
  EXPECT_EQ(rig.state.proxy.z, 0);
}

TEST(Plane, OneSidedReleaseAndReArm) {
  Rig rig(build(kFloor + R"(, "free": "above", "release": 0.25})"));
  expect_steps(rig, {{{0, 0, 0.1}, kFree}, {{0, 0, -0.2}, kOk}, {{0, 0, -0.25}, kReleased, {0, 0, -0.25}}});
  EXPECT_FALSE(rig.state.active());
  expect_steps(rig, {{{0, 0, -0.01}, kReleased},  // a one-sided link re-arms only on the free side
                     {{0, 0, 0.01}, kFree}});
  EXPECT_TRUE(rig.state.active());
  EXPECT_EQ(rig.tick({0, 0, -0.01}).status, LinkStatus::ok);
}

TEST(Plane, TwoSidedReleaseAndReArm) {
  const auto plane = build(kFloor + R"(, "release": 0.25})");
  Rig rig(plane);
  expect_steps(rig, {{{0, 0, 0.2}, kOk},
                     {{0, 0, 0.3}, kReleased},
                     {{0, 0, 0.026}, kReleased},
                     {{0, 0, 0.024}, kOk},  // within a tenth of release
                     {{0, 0, 0.3}, kReleased},
                     {{0, 0, -0.1}, kOk},  // crossed the level
                     {{0, 0, 0.1}, kOk}});
}

TEST(Plane, FirstProbeDeeperThanReleaseStartsReleased) {
  Rig deep(build(kFloor + R"(, "free": "above", "release": 0.25})"));
  EXPECT_EQ(deep.tick({0, 0, -0.3}).status, LinkStatus::released);
  Rig shallow(build(kFloor + R"(, "free": "above", "release": 0.25})"));
  EXPECT_EQ(shallow.tick({0, 0, -0.2}).status, LinkStatus::ok);
}

TEST(Plane, RefusesBadKeys) {
  expect_refused("{\"name\": \"a\", \"type\": \"plane\", \"point\": [0, 0, 0],\n \"normal\": [0, 0, 0]}", 2, {});
  for (const char* bad : {R"("free": "left")", R"("release": 0)", R"("colour": 1)"})
    EXPECT_FALSE(try_build(kFloor + ", " + bad + "}")) << bad;
}

}  // namespace catena::haptics::tests::plane_test
