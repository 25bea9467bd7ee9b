// SPDX-License-Identifier: MIT
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests {
namespace segment_test {

/// The closest point of the segment a..b in extended precision.
Vec3 reference(const Vec3& a, const Vec3& b, const Vec3& x) {
  long double up = 0, down = 0;
  for (int i = 0; i < 3; ++i) {
    const long double d = static_cast<long double>(b[i]) - a[i];
    up += (static_cast<long double>(x[i]) - a[i]) * d;
    down += d * d;
  }
  const long double t = std::clamp(up / down, 0.0L, 1.0L);
  Vec3 p;
  for (int i = 0; i < 3; ++i) p[i] = static_cast<double>(a[i] + t * (static_cast<long double>(b[i]) - a[i]));
  return p;
}

std::string segment(const Vec3& a, const Vec3& b, const std::string& more = "") {
  char text[300];
  std::snprintf(text, sizeof text, R"({"name": "a", "type": "segment", "from": [%.17g, %.17g, %.17g], "to": [%.17g, %.17g, %.17g])", a.x,
                a.y, a.z, b.x, b.y, b.z);
  return text + more + "}";
}

TEST(Segment, IsTheClosestPoint) {
  Random random(3);
  int ends = 0;
  for (int i = 0; i < 50; ++i) {
    const Vec3 a = random.box(1), b = random.box(1);
    Rig rig(build(segment(a, b)));
    for (int k = 0; k < 100; ++k) {
      const Vec3 probe = random.box(2);
      rig.tick(probe);
      EXPECT_LE(norm(rig.state.proxy - reference(a, b, probe)), 2e-15);
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
  const Vec3 a(0, 0, 0), b(1, 0, 0);
  Rig rig(build(segment(a, b)));
  Vec3 last_probe(-0.5, 0.3, 0), last = rig.tick(last_probe).proxy;
  for (int i = 1; i <= 2000; ++i) {
    const Vec3 probe(-0.5 + i * 1e-3, 0.3, 0), proxy = rig.tick(probe).proxy;
    EXPECT_LE(norm(proxy - last), norm(probe - last_probe) * (1 + 1e-12));
    last = proxy;
    last_probe = probe;
  }
}

TEST(Segment, TinyAndHugeSegments) {
  Rig tiny(build(segment({0, 0, 0}, {0, 1e-310, 0})));
  EXPECT_TRUE(bitwise_equal(tiny.tick({1, 1, 1}).proxy, Vec3(0, 1e-310, 0)));
  EXPECT_TRUE(bitwise_equal(tiny.tick({1, 4e-311, 1}).proxy, Vec3(0, 4e-311, 0)));
  Rig huge(build(segment({-1e300, 0, 0}, {1e300, 0, 0})));
  EXPECT_LE(std::fabs(huge.tick({5e299, 1e300, -1e300}).proxy.x - 5e299), 1e285);
  EXPECT_EQ(huge.state.status, LinkStatus::ok);
}

TEST(Segment, ReleasesAndReArmsWithinATenth) {
  Rig rig(build(segment({0, 0, 0}, {1, 0, 0}, R"(, "release": 0.5)")));
  EXPECT_EQ(rig.tick({1.49, 0, 0}).status, LinkStatus::ok);
  EXPECT_EQ(rig.tick({1.5, 0, 0}).status, LinkStatus::released);
  EXPECT_EQ(rig.tick({0.5, 0.0501, 0}).status, LinkStatus::released);
  EXPECT_EQ(rig.tick({0.5, 0.0499, 0}).status, LinkStatus::ok);
}

TEST(Segment, ThePrimitiveIsALineAndBeyondAnEndAPoint) {
  Rig rig(build(segment({0, 0, 0}, {0, 0, 2})));
  rig.tick({1, 0, 1});
  Primitive primitive;
  ASSERT_TRUE(rig.constraint->primitive({1, 0, 0.5}, rig.state, rig.scratch, primitive));
  EXPECT_EQ(primitive.kind, Primitive::Kind::line);
  EXPECT_TRUE(bitwise_equal(primitive.origin, Vec3(0, 0, 0.5)));
  EXPECT_TRUE(bitwise_equal(primitive.axis, Vec3(0, 0, 1)));
  ASSERT_TRUE(rig.constraint->primitive({1, 0, 2.5}, rig.state, rig.scratch, primitive));
  EXPECT_EQ(primitive.kind, Primitive::Kind::point);
  EXPECT_TRUE(bitwise_equal(primitive.origin, Vec3(0, 0, 2)));
}

TEST(Segment, RefusesBadKeys) {
  const auto same = try_build("{\"name\": \"a\", \"type\": \"segment\", \"from\": [1, 2, 3],\n \"to\": [1, 2, 3]}");
  ASSERT_FALSE(same);
  EXPECT_EQ(same.error().message.rfind("scene.json:2:", 0), 0u) << same.error().message;
  EXPECT_FALSE(try_build(segment({-1.7e308, 0, 0}, {1.7e308, 0, 0})));
  EXPECT_FALSE(try_build(R"({"name": "a", "type": "segment", "from": [0, 0, 0]})"));
  EXPECT_FALSE(try_build(segment({0, 0, 0}, {1, 0, 0}, R"(, "free": "above")")));
}

}  // namespace segment_test
}  // namespace catena::haptics::tests
