// SPDX-License-Identifier: MIT
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::sphere_test {

std::string sphere(double radius, const std::string& more = "") {
  return R"({"name": "a", "type": "sphere", "center": [0, 0, 0], "radius": )" + to_json(radius) + more + "}";
}

TEST(Sphere, IsTheClosestPoint) {
  const Vec3 c(0.5, -1, 2);
  Rig rig(build(R"({"name": "a", "type": "sphere", "center": [0.5, -1, 2], "radius": 0.75})"));
  Random random(2);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 probe = c + random.unit() * random.uniform(1e-6, 3);
    EXPECT_LE(norm(rig.tick(probe).proxy - (c + (probe - c) * (0.75 / norm(probe - c)))), 1e-15);
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
  expect_steps(sphere(1), {{{0, 0, 0}, {}, {1, 0, 0}}, {{0, 0, -0.3}}, {{0, 0, 0}, {}, {0, 0, -1}}, {{-0.0, 0, -0.0}, kOk, {0, 0, -1}}});
}

TEST(Sphere, FreeAboveIsOutsideAndFreeBelowIsInside) {
  expect_steps(sphere(1, R"(, "free": "above")"), {{{1.5, 0, 0}, kFree, {1.5, 0, 0}}, {{0.5, 0, 0}, kOk, {1, 0, 0}}});
  expect_steps(sphere(1, R"(, "free": "below")"), {{{0.5, 0, 0}, kFree}, {{0, 1.5, 0}, kOk, {0, 1, 0}}, {{0, 1, 0}, kFree}});
}

TEST(Sphere, OneSidedReleaseAndReArm) {
  const Step steps[] = {{{1.2, 0, 0}, kFree},      {{0.76, 0, 0}, kOk},   {{0.75, 0, 0}, kReleased},
                        {{0.99, 0, 0}, kReleased}, {{1.01, 0, 0}, kFree}, {{0.99, 0, 0}, kOk}};
  expect_steps(sphere(1, R"(, "free": "above", "release": 0.25)"), steps);
  Rig deep(build(sphere(1, R"(, "free": "above", "release": 0.25)")));
  EXPECT_EQ(deep.tick({0.7, 0, 0}).status, LinkStatus::released);
}

TEST(Sphere, TwoSidedReleaseAndReArm) {
  expect_steps(sphere(1, R"(, "release": 0.25)"), {{{0.8, 0, 0}, kOk},
                                                   {{1.3, 0, 0}, kReleased},
                                                   {{1.026, 0, 0}, kReleased},
                                                   {{1.024, 0, 0}, kOk},
                                                   {{1.3, 0, 0}, kReleased},
                                                   {{0.9, 0, 0}, kOk},  // crossed the surface
                                                   {{0.7, 0, 0}, kReleased}});
  // in and out within one tick, then held at the closest point
  Rig passed(build(sphere(0.1, R"(, "release": 0.25)")));
  expect_steps(passed, {{{0.2, 0, 0}}, {{0.5, 0.05, 0}, kReleased}, {{-0.3, 0.05, 0}, kOk}});
  EXPECT_LE(norm(passed.state.proxy - direction(Vec3(-0.3, 0.05, 0)) * 0.1), 1e-16);
}

TEST(Sphere, TheForceIsContinuousFromOutsideAndInside) {
  for (const double distance : {0.6, 1.7}) {
    Rig rig(build(sphere(1)));
    const auto path = [&](int i) { return direction(Vec3(std::cos(i * 0.003), std::sin(i * 0.003), std::sin(i * 0.001))) * distance; };
    expect_no_jumps(rig, 3999, path, 0, 0.0045);
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
  rig.tick({0, 1.9, 0});
  expect_primitive(rig, {0, 0, 1}, Primitive::Kind::plane, {0, 0, 2}, {0, 0, 1});
}

TEST(Sphere, RefusesBadKeys) {
  for (const std::string& bad : {sphere(0), sphere(-1), sphere(1, R"(, "free": "left")"), sphere(1, R"(, "colour": 1)"),
                                 std::string(R"({"name": "a", "type": "sphere", "radius": 1})")})
    EXPECT_FALSE(try_build(bad)) << bad;
}

}  // namespace catena::haptics::tests::sphere_test
