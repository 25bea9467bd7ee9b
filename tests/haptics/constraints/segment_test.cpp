// SPDX-License-Identifier: MIT
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::segment_test {

std::string segment(const Vec3& a, const Vec3& b, const std::string& more = "") {
  return R"({"name": "a", "type": "segment", "from": )" + to_json(a) + R"(, "to": )" + to_json(b) + more + "}";
}

TEST(Segment, IsTheClosestPoint) {
  Random random(3);
  int ends = 0;
  for (int i = 0; i < 50; ++i) {
    const Vec3 a = random.box(1), b = random.box(1);
    Rig rig(build(segment(a, b)));
    for (int k = 0; k < 100; ++k) {
      const Vec3 probe = random.box(2);
      EXPECT_LE(norm(rig.tick(probe).proxy - closest_on_segment(a, b, probe)), 2e-15);
      EXPECT_LE(rig.state.residual, 1e-15);
      EXPECT_EQ(rig.state.status, LinkStatus::ok);
      ends += bitwise_equal(rig.state.proxy, a) || bitwise_equal(rig.state.proxy, b);
    }
  }
  EXPECT_GT(ends, 1000);
  EXPECT_LT(ends, 4500);
}

TEST(Segment, HoldsAtItsEndsBitForBit) {
  const Vec3 a(0.1, 0.2, 0.3), b(0.4, -0.7, 1.1);
  Rig rig(build(segment(a, b)));
  for (const double scale : {1.0, 1e3, 1e16, 1e160, 1e300}) {
    EXPECT_TRUE(bitwise_equal(rig.tick(b + (b - a) * scale).proxy, b)) << scale;
    EXPECT_EQ(rig.state.residual, 0);
    EXPECT_TRUE(bitwise_equal(rig.tick(a - (b - a) * scale).proxy, a)) << scale;
  }
}

TEST(Segment, NeverMovesFurtherThanTheProbe) {
  Rig rig(build(segment({0, 0, 0}, {1, 0, 0})));
  expect_no_jumps(
      rig, 2000, [](int i) { return Vec3(-0.5 + i * 1e-3, 0.3, 0); }, 1 + 1e-12);
}

TEST(Segment, TinyAndHugeSegments) {
  expect_steps(segment({0, 0, 0}, {0, 1e-310, 0}), {{{1, 1, 1}, {}, {0, 1e-310, 0}}, {{1, 4e-311, 1}, {}, {0, 4e-311, 0}}});
  Rig huge(build(segment({-1e300, 0, 0}, {1e300, 0, 0})));
  EXPECT_LE(std::fabs(huge.tick({5e299, 1e300, -1e300}).proxy.x - 5e299), 1e285);
  EXPECT_EQ(huge.state.status, LinkStatus::ok);
}

TEST(Segment, ReleasesAndReArmsWithinATenth) {
  Rig rig(build(segment({0, 0, 0}, {1, 0, 0}, R"(, "release": 0.5)")));
  expect_steps(rig, {{{1.49, 0, 0}, kOk}, {{1.5, 0, 0}, kReleased}, {{0.5, 0.0501, 0}, kReleased}, {{0.5, 0.0499, 0}, kOk}});
}

TEST(Segment, ThePrimitiveIsALineAndBeyondAnEndAPoint) {
  Rig rig(build(segment({0, 0, 0}, {0, 0, 2})));
  rig.tick({1, 0, 1});
  expect_primitive(rig, {1, 0, 0.5}, Primitive::Kind::line, {0, 0, 0.5}, {0, 0, 1});
  expect_primitive(rig, {1, 0, 2.5}, Primitive::Kind::point, {0, 0, 2});
}

TEST(Segment, RefusesBadKeys) {
  expect_refused("{\"name\": \"a\", \"type\": \"segment\", \"from\": [1, 2, 3],\n \"to\": [1, 2, 3]}", 2, {});
  EXPECT_FALSE(try_build(segment({-1.7e308, 0, 0}, {1.7e308, 0, 0})));
  EXPECT_FALSE(try_build(R"({"name": "a", "type": "segment", "from": [0, 0, 0]})"));
  EXPECT_FALSE(try_build(segment({0, 0, 0}, {1, 0, 0}, R"(, "free": "above")")));
}

}  // namespace catena::haptics::tests::segment_test
