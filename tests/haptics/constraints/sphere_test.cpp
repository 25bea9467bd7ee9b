// SPDX-License-Identifier: MIT
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests {
namespace sphere_test {

std::string sphere(double radius, const std::string& more = "") {
  char text[120];
  std::snprintf(text, sizeof text, R"({"name": "a", "type": "sphere", "center": [0, 0, 0], "radius": %.17g)", radius);
  return text + more + "}";
}

TEST(Sphere, IsTheClosestPoint) {
  const Vec3 c(0.5, -1, 2);
  Rig rig(build(R"({"name": "a", "type": "sphere", "center": [0.5, -1, 2], "radius": 0.75})"));
  Random random(2);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 probe = c + random.unit() * random.uniform(1e-6, 3);
    rig.tick(probe);
    EXPECT_LE(norm(rig.state.proxy - (c + (probe - c) * (0.75 / norm(probe - c)))), 1e-15);
    EXPECT_LE(rig.state.residual, 1e-15);
    EXPECT_EQ(rig.state.status, LinkStatus::ok);
  }
}

TEST(Sphere, FarAndTinyProbesAndRadii) {
  Rig rig(build(sphere(1)));
  for (const double scale : {1e-320, 1e-300, 1e-150, 1e150, 1e300}) {
    rig.tick(Vec3(3, 4, 0) * scale);
    EXPECT_LE(norm(rig.state.proxy - Vec3(0.6, 0.8, 0)), scale < 1e-310 ? 1e-3 : 3e-16) << scale;
    EXPECT_LE(rig.state.residual, 3e-16);
  }
  Rig huge(build(sphere(1e300)));
  EXPECT_LE(norm(huge.tick({1, 0, 0}).proxy - Vec3(1e300, 0, 0)), 1e285);
}

TEST(Sphere, TheCentreKeepsTheLastNormal) {
  Rig rig(build(sphere(1)));
  EXPECT_TRUE(bitwise_equal(rig.tick({0, 0, 0}).proxy, Vec3(1, 0, 0)));
  rig.tick({0, 0, -0.3});
  EXPECT_TRUE(bitwise_equal(rig.tick({0, 0, 0}).proxy, Vec3(0, 0, -1)));
  EXPECT_TRUE(bitwise_equal(rig.tick({-0.0, 0, -0.0}).proxy, Vec3(0, 0, -1)));
  EXPECT_EQ(rig.state.status, LinkStatus::ok);
}

TEST(Sphere, FreeAboveIsOutsideAndFreeBelowIsInside) {
  Rig ball(build(sphere(1, R"(, "free": "above")")));
  EXPECT_EQ(ball.tick({1.5, 0, 0}).status, LinkStatus::free);
  EXPECT_TRUE(bitwise_equal(ball.state.proxy, Vec3(1.5, 0, 0)));
  EXPECT_EQ(ball.tick({0.5, 0, 0}).status, LinkStatus::ok);
  EXPECT_TRUE(bitwise_equal(ball.state.proxy, Vec3(1, 0, 0)));
  Rig room(build(sphere(1, R"(, "free": "below")")));
  EXPECT_EQ(room.tick({0.5, 0, 0}).status, LinkStatus::free);
  EXPECT_EQ(room.tick({0, 1.5, 0}).status, LinkStatus::ok);
  EXPECT_TRUE(bitwise_equal(room.state.proxy, Vec3(0, 1, 0)));
  EXPECT_EQ(room.tick({0, 1, 0}).status, LinkStatus::free);
}

TEST(Sphere, OneSidedReleaseAndReArm) {
  Rig rig(build(sphere(1, R"(, "free": "above", "release": 0.25)")));
  EXPECT_EQ(rig.tick({1.2, 0, 0}).status, LinkStatus::free);
  EXPECT_EQ(rig.tick({0.76, 0, 0}).status, LinkStatus::ok);
  EXPECT_EQ(rig.tick({0.75, 0, 0}).status, LinkStatus::released);
  EXPECT_EQ(rig.tick({0.99, 0, 0}).status, LinkStatus::released);
  EXPECT_EQ(rig.tick({1.01, 0, 0}).status, LinkStatus::free);
  EXPECT_EQ(rig.tick({0.99, 0, 0}).status, LinkStatus::ok);
  Rig deep(build(sphere(1, R"(, "free": "above", "release": 0.25)")));
  EXPECT_EQ(deep.tick({0.7, 0, 0}).status, LinkStatus::released);
}

TEST(Sphere, TwoSidedReleaseAndReArm) {
  Rig rig(build(sphere(1, R"(, "release": 0.25)")));
  EXPECT_EQ(rig.tick({0.8, 0, 0}).status, LinkStatus::ok);
  EXPECT_EQ(rig.tick({1.3, 0, 0}).status, LinkStatus::released);
  EXPECT_EQ(rig.tick({1.026, 0, 0}).status, LinkStatus::released);
  EXPECT_EQ(rig.tick({1.024, 0, 0}).status, LinkStatus::ok);
  EXPECT_EQ(rig.tick({1.3, 0, 0}).status, LinkStatus::released);
  EXPECT_EQ(rig.tick({0.9, 0, 0}).status, LinkStatus::ok);  // crossed the surface
  EXPECT_EQ(rig.tick({0.7, 0, 0}).status, LinkStatus::released);
  // in and out within one tick, then held at the closest point
  Rig passed(build(sphere(0.1, R"(, "release": 0.25)")));
  passed.tick({0.2, 0, 0});
  EXPECT_EQ(passed.tick({0.5, 0.05, 0}).status, LinkStatus::released);
  EXPECT_EQ(passed.tick({-0.3, 0.05, 0}).status, LinkStatus::ok);
  EXPECT_LE(norm(passed.state.proxy - direction(Vec3(-0.3, 0.05, 0)) * 0.1), 1e-16);
}

TEST(Sphere, TheForceIsContinuousFromOutsideAndInside) {
  for (const double distance : {0.6, 1.7}) {
    Rig rig(build(sphere(1)));
    Vec3 last = rig.tick({distance, 0, 0}).proxy;
    for (int i = 1; i < 4000; ++i) {
      const Vec3 probe = direction(Vec3(std::cos(i * 0.003), std::sin(i * 0.003), std::sin(i * 0.001))) * distance;
      const Vec3 proxy = rig.tick(probe).proxy;
      ASSERT_LE(norm(proxy - last), 0.0045) << i;
      last = proxy;
    }
  }
}

TEST(Sphere, ASmallSphereIsNotPassedThroughWithinOneTick) {
  Random random(8);
  for (int i = 0; i < 500; ++i) {
    Rig rig(build(sphere(0.01, R"(, "free": "above")")));
    const Vec3 way = random.unit(), aside = direction(cross(way, random.unit())) * random.uniform(0, 0.009);
    rig.tick(aside - way * 0.1);
    rig.tick(aside - way * 0.035);
    ASSERT_EQ(rig.tick(aside + way * 0.035).status, LinkStatus::ok);  // within 0.02 L = 0.08
    ASSERT_LE(rig.state.residual, 1e-16);
    ASSERT_LT(dot(rig.state.proxy, way), 0);
    ASSERT_EQ(rig.tick(aside + way * 0.04).status, LinkStatus::ok);
    ASSERT_LT(dot(rig.state.proxy, way), 0);
    ASSERT_EQ(rig.tick(aside - way * 0.035).status, LinkStatus::free);  // returned
    rig.tick(aside + way * 0.035);
    ASSERT_EQ(rig.tick(aside + way * 0.1).status, LinkStatus::ok);    // at any distance behind
    ASSERT_EQ(rig.tick(aside + way * 0.2).status, LinkStatus::free);  // a step of more than 0.02 L
  }
}

TEST(Sphere, CuttingACapOrPassingBesideIsFree) {
  Rig cap(build(sphere(1, R"(, "free": "above")")));
  cap.tick({-0.035, 1.0004, 0});
  EXPECT_EQ(cap.tick({0.035, 1.0004, 0}).status, LinkStatus::free);  // the chord is 0.0002 deep
  Rig beside(build(sphere(0.01, R"(, "free": "above")")));
  beside.tick({-0.03, 0.0101, 0});
  EXPECT_EQ(beside.tick({0.03, 0.0101, 0}).status, LinkStatus::free);
  Rig jump(build(sphere(0.01, R"(, "free": "above")")));
  jump.tick({-0.5, 0, 0});
  EXPECT_EQ(jump.tick({0.5, 0, 0}).status, LinkStatus::free);  // a jump, not a hand's motion
}

TEST(Sphere, ThePrimitiveIsTheTangentPlane) {
  Rig rig(build(sphere(2, R"(, "free": "above")")));
  Primitive primitive;
  rig.tick({0, 1.9, 0});
  ASSERT_TRUE(rig.constraint->primitive({0, 0, 1}, rig.state, rig.scratch, primitive));
  EXPECT_EQ(primitive.kind, Primitive::Kind::plane);
  EXPECT_TRUE(bitwise_equal(primitive.origin, Vec3(0, 0, 2)));
  EXPECT_TRUE(bitwise_equal(primitive.axis, Vec3(0, 0, 1)));
}

TEST(Sphere, RefusesBadKeys) {
  EXPECT_FALSE(try_build(sphere(0)));
  EXPECT_FALSE(try_build(sphere(-1)));
  EXPECT_FALSE(try_build(sphere(1, R"(, "free": "left")")));
  EXPECT_FALSE(try_build(sphere(1, R"(, "colour": 1)")));
  EXPECT_FALSE(try_build(R"({"name": "a", "type": "sphere", "radius": 1})"));
}

}  // namespace sphere_test
}  // namespace catena::haptics::tests
