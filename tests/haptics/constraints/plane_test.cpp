// SPDX-License-Identifier: MIT
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests {
namespace plane_test {

const std::string kFloor = R"({"name": "a", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 5])";

TEST(Plane, ProjectsOrthogonally) {
  Rig rig(build(R"({"name": "a", "type": "plane", "point": [1, 2, 3], "normal": [1, 2, -2]})"));
  Random random(1);
  const Vec3 n = Vec3(1, 2, -2) / 3.0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 probe = random.box(10);
    rig.tick(probe);
    EXPECT_LE(std::fabs(dot(n, rig.state.proxy - Vec3(1, 2, 3))), 1e-14 * 10);
    EXPECT_LE(norm(cross(n, probe - rig.state.proxy)), 1e-14 * 10);
    EXPECT_EQ(rig.state.status, LinkStatus::ok);
  }
}

TEST(Plane, IsFreeAboveAndHeldBelow) {
  Rig rig(build(kFloor + R"(, "free": "above"})"));
  EXPECT_EQ(rig.tick({0.1, 0.2, 0.3}).status, LinkStatus::free);
  EXPECT_TRUE(bitwise_equal(rig.state.proxy, Vec3(0.1, 0.2, 0.3)));
  EXPECT_TRUE(rig.state.active());
  EXPECT_EQ(rig.tick({0.1, 0.2, -0.3}).status, LinkStatus::ok);  // within the tick of the crossing
  EXPECT_TRUE(bitwise_equal(rig.state.proxy, Vec3(0.1, 0.2, 0)));
  EXPECT_EQ(rig.tick({0.1, 0.2, 1e-9}).status, LinkStatus::free);
}

TEST(Plane, IsFreeBelow) {
  Rig rig(build(kFloor + R"(, "free": "below"})"));
  EXPECT_EQ(rig.tick({0, 0, -1}).status, LinkStatus::free);
  EXPECT_EQ(rig.tick({0, 0, 1}).status, LinkStatus::ok);
  EXPECT_EQ(rig.state.proxy.z, 0);
}

TEST(Plane, OneSidedReleaseAndReArm) {
  Rig rig(build(kFloor + R"(, "free": "above", "release": 0.25})"));
  EXPECT_EQ(rig.tick({0, 0, 0.1}).status, LinkStatus::free);
  EXPECT_EQ(rig.tick({0, 0, -0.2}).status, LinkStatus::ok);
  EXPECT_EQ(rig.tick({0, 0, -0.25}).status, LinkStatus::released);
  EXPECT_TRUE(bitwise_equal(rig.state.proxy, Vec3(0, 0, -0.25)));
  EXPECT_FALSE(rig.state.active());
  EXPECT_EQ(rig.tick({0, 0, -0.01}).status, LinkStatus::released);  // a one-sided link re-arms only on the free side
  EXPECT_EQ(rig.tick({0, 0, 0.01}).status, LinkStatus::free);
  EXPECT_TRUE(rig.state.active());
  EXPECT_EQ(rig.tick({0, 0, -0.01}).status, LinkStatus::ok);
}

TEST(Plane, TwoSidedReleaseAndReArm) {
  const auto plane = build(kFloor + R"(, "release": 0.25})");
  Rig rig(plane);
  EXPECT_EQ(rig.tick({0, 0, 0.2}).status, LinkStatus::ok);
  EXPECT_EQ(rig.tick({0, 0, 0.3}).status, LinkStatus::released);
  EXPECT_EQ(rig.tick({0, 0, 0.026}).status, LinkStatus::released);
  EXPECT_EQ(rig.tick({0, 0, 0.024}).status, LinkStatus::ok);  // within a tenth of release
  EXPECT_EQ(rig.tick({0, 0, 0.3}).status, LinkStatus::released);
  EXPECT_EQ(rig.tick({0, 0, -0.1}).status, LinkStatus::ok);  // crossed the level
  EXPECT_EQ(rig.tick({0, 0, 0.1}).status, LinkStatus::ok);
}

TEST(Plane, FirstProbeDeeperThanReleaseStartsReleased) {
  Rig deep(build(kFloor + R"(, "free": "above", "release": 0.25})"));
  EXPECT_EQ(deep.tick({0, 0, -0.3}).status, LinkStatus::released);
  Rig shallow(build(kFloor + R"(, "free": "above", "release": 0.25})"));
  EXPECT_EQ(shallow.tick({0, 0, -0.2}).status, LinkStatus::ok);
}

TEST(Plane, RefusesBadKeys) {
  const auto zero = try_build("{\"name\": \"a\", \"type\": \"plane\", \"point\": [0, 0, 0],\n \"normal\": [0, 0, 0]}");
  ASSERT_FALSE(zero);
  EXPECT_EQ(zero.error().message.rfind("scene.json:2:", 0), 0u) << zero.error().message;
  EXPECT_FALSE(try_build(kFloor + R"(, "free": "left"})"));
  EXPECT_FALSE(try_build(kFloor + R"(, "release": 0})"));
  EXPECT_FALSE(try_build(kFloor + R"(, "colour": 1})"));
}

}  // namespace plane_test
}  // namespace catena::haptics::tests
