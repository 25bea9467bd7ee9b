// SPDX-License-Identifier: MIT
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::line_test {

TEST(Line, ProjectsOrthogonally) {
  Rig rig(build(R"({"name": "a", "type": "line", "point": [1, 2, 3], "direction": [2, 4, -4]})"));
  Random random(1);
  const Vec3 d = Vec3(1, 2, -2) / 3.0, point(1, 2, 3);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 probe = random.box(10);
    EXPECT_LE(std::fabs(dot(d, probe - rig.tick(probe).proxy)), 1e-14);
    EXPECT_LE(norm(cross(d, rig.state.proxy - point)), 1e-14);
    EXPECT_LE(rig.state.residual, 1e-14);
    EXPECT_EQ(rig.state.status, LinkStatus::ok);
    EXPECT_EQ(rig.state.evaluations, 0);
  }
}

TEST(Line, IsInfiniteAndAccurateFarFromTheOrigin) {
  Rig rig(build(R"({"name": "a", "type": "line", "point": [1, 2, 3], "direction": [1, 2, 2]})"));
  for (const double scale : {1e3, 1e9, 1e150, 1e200, 1e300}) {
    const Vec3 probe = Vec3(1, -0.5, 0.25) * scale;
    rig.tick(probe);
    const Vec3 p = rig.state.proxy / scale, expected = (Vec3(1, 2, 2) / 9.0) * 0.5;
    EXPECT_LE(norm(p - expected), 4 / scale + 4e-16) << scale;
    EXPECT_LE(rig.state.residual, 4e-16 * scale + 1e-15) << scale;
    EXPECT_EQ(rig.state.status, LinkStatus::ok);
  }
}

TEST(Line, TheLengthOfTheDirectionDoesNotMatter) {
  Rig one(build(R"({"name": "a", "type": "line", "point": [0, 0, 0], "direction": [1, 2, -2]})"));
  for (const char* other : {"[1e-300, 2e-300, -2e-300]", "[1e300, 2e300, -2e300]"}) {
    Rig rig(build(std::string(R"({"name": "a", "type": "line", "point": [0, 0, 0], "direction": )") + other + "}"));
    const Vec3 expected = one.tick({0.3, 0.4, 0.5}).proxy;
    EXPECT_LE(norm(rig.tick({0.3, 0.4, 0.5}).proxy - expected), 1e-16);
  }
}

TEST(Line, ReleasesAndReArmsWithinATenth) {
  Rig rig(build(R"({"name": "a", "type": "line", "point": [0, 0, 0], "direction": [1, 0, 0], "release": 0.5})"));
  EXPECT_EQ(rig.tick({3, 0.49, 0}).status, LinkStatus::ok);
  EXPECT_EQ(rig.state.limit, 0.5);
  expect_steps(rig, {{{3, 0, 0.5}, kReleased, {3, 0, 0.5}}, {{9, 0, 0.0501}, kReleased}, {{9, 0, 0.0499}, kOk, {9, 0, 0}}});
}

TEST(Line, ForwardAndBackwardSweepsAreBitIdentical) {
  Rig rig(build(R"({"name": "a", "type": "line", "point": [0.1, 0.2, 0.3], "direction": [0.3, -0.2, 0.7]})"));
  std::vector<Vec3> there;
  for (int i = 0; i <= 100; ++i) there.push_back(rig.tick({0.01 * i, 0.5, -0.02 * i}).proxy);
  for (int i = 100; i >= 0; --i) EXPECT_TRUE(bitwise_equal(rig.tick({0.01 * i, 0.5, -0.02 * i}).proxy, there[static_cast<std::size_t>(i)]));
}

TEST(Line, ThePrimitiveIsTheLine) {
  Rig rig(build(R"({"name": "a", "type": "line", "point": [0, 0, 1], "direction": [0, 3, 0], "release": 0.5})"));
  ASSERT_TRUE(rig.constraint->has_primitive());
  rig.tick({0.1, 2, 1});
  expect_primitive(rig, {0.3, 4, 1}, Primitive::Kind::line, {0, 4, 1}, {0, 1, 0});
  rig.tick({0.6, 2, 1});
  Primitive primitive;
  EXPECT_FALSE(rig.constraint->primitive({0.3, 4, 1}, rig.state, rig.scratch, primitive));  // released
}

TEST(Line, RefusesBadKeys) {
  const std::string head = R"({"name": "a", "type": "line", "point": [0, 0, 0])";
  expect_refused(head + ",\n \"direction\": [0, 0, 0]}", 2, {});
  EXPECT_FALSE(try_build(R"({"name": "a", "type": "line", "direction": [0, 0, 1]})"));
  for (const char* bad : {"", R"(, "direction": [0, 0, 1], "free": "above")", R"(, "direction": [0, 0, 1], "release": 0)"})
    EXPECT_FALSE(try_build(head + bad + "}")) << bad;
}

}  // namespace catena::haptics::tests::line_test
