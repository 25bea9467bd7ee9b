// SPDX-License-Identifier: MIT
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests {
namespace point_test {

TEST(Point, HoldsTheProxyAtItsPosition) {
  Rig rig(build(R"({"name": "a", "type": "point", "position": [1, -2, 3]})"));
  for (const Vec3& probe : {Vec3(0.0), Vec3(1, -2, 3), Vec3(1e6, 0, 0)}) {
    rig.tick(probe);
    EXPECT_TRUE(bitwise_equal(rig.state.proxy, Vec3(1, -2, 3)));
    EXPECT_EQ(rig.state.status, LinkStatus::ok);
    EXPECT_EQ(rig.state.residual, 0);
    EXPECT_TRUE(rig.state.active());
  }
}

TEST(Point, ReleasesAndReArmsWithinATenth) {
  Rig rig(build(R"({"name": "a", "type": "point", "position": [0, 0, 0], "release": 0.5})"));
  EXPECT_EQ(rig.tick({0.49, 0, 0}).status, LinkStatus::ok);
  EXPECT_EQ(rig.tick({0.5, 0, 0}).status, LinkStatus::released);
  EXPECT_FALSE(rig.state.active());
  EXPECT_TRUE(bitwise_equal(rig.state.proxy, Vec3(0.5, 0, 0)));
  EXPECT_EQ(rig.tick({0.0501, 0, 0}).status, LinkStatus::released);
  EXPECT_EQ(rig.tick({0.0499, 0, 0}).status, LinkStatus::ok);
  EXPECT_TRUE(rig.state.active());
}

TEST(Point, RefusesBadKeys) {
  EXPECT_FALSE(try_build(R"({"name": "a", "type": "point"})"));
  EXPECT_FALSE(try_build(R"({"name": "a", "type": "point", "position": [0, 0]})"));
  EXPECT_FALSE(try_build(R"({"name": "a", "type": "point", "position": [0, 0, 0], "release": 0})"));
  EXPECT_FALSE(try_build(R"({"name": "a", "type": "point", "position": [0, 0, 0], "release": -1})"));
  EXPECT_FALSE(try_build(R"({"name": "a", "type": "point", "position": [0, 0, 0], "free": "above"})"));
}

}  // namespace point_test
}  // namespace catena::haptics::tests
