// SPDX-License-Identifier: MIT
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::point_test {

TEST(Point, HoldsTheProxyAtItsPosition) {
  Rig rig(build(R"({"name": "a", "type": "point", "position": [1, -2, 3]})"));
  for (const Vec3& probe : {Vec3(0.0), Vec3(1, -2, 3), Vec3(1e6, 0, 0)}) {
    EXPECT_TRUE(bitwise_equal(rig.tick(probe).proxy, Vec3(1, -2, 3)));
    EXPECT_EQ(rig.state.status, LinkStatus::ok);
    EXPECT_EQ(rig.state.residual, 0);
    EXPECT_TRUE(rig.state.active());
  }
}

TEST(Point, ReleasesAndReArmsWithinATenth) {
  Rig rig(build(R"({"name": "a", "type": "point", "position": [0, 0, 0], "release": 0.5})"));
  expect_steps(rig, {{{0.49, 0, 0}, kOk}, {{0.5, 0, 0}, kReleased}});
  EXPECT_FALSE(rig.state.active());
  EXPECT_TRUE(bitwise_equal(rig.state.proxy, Vec3(0.5, 0, 0)));
  expect_steps(rig, {{{0.0501, 0, 0}, kReleased}, {{0.0499, 0, 0}, kOk}});
  EXPECT_TRUE(rig.state.active());
}

TEST(Point, RefusesBadKeys) {
  for (const char* bad : {"", R"(, "position": [0, 0])", R"(, "position": [0, 0, 0], "release": 0)",
                          R"(, "position": [0, 0, 0], "release": -1)", R"(, "position": [0, 0, 0], "free": "above")"})
    EXPECT_FALSE(try_build(std::string(R"({"name": "a", "type": "point")") + bad + "}")) << bad;
}

}  // namespace catena::haptics::tests::point_test
