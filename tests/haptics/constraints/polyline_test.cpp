// SPDX-License-Identifier: MIT
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::polyline_test {

std::string polyline(const std::vector<Vec3>& points, const std::string& more = "") {
  std::string text = R"({"name": "a", "type": "polyline", "points": [)";
  for (const Vec3& p : points) text += (&p == &points.front() ? "" : ", ") + to_json(p);
  return text + "]" + more + "}";
}

const std::string kClosed = R"(, "closed": true)";

/// Distance from the closest point of all segments.
double brute_distance(const std::vector<Vec3>& points, bool closed, const Vec3& x) {
  double minimum = 1e300;
  for (std::size_t k = 0; k + (closed ? 0 : 1) < points.size(); ++k)
    minimum = std::min(minimum, norm(x - closest_on_segment(points[k], points[(k + 1) % points.size()], x)));
  return minimum;
}

std::vector<Vec3> walk(Random& random, int count, double step) {
  std::vector<Vec3> points{random.box(1)};
  for (int i = 1; i < count; ++i) points.push_back(points.back() * 0.99 + random.box(step));
  return points;
}

TEST(Polyline, StartsAtTheClosestPoint) {
  Random random(1);
  for (const int count : {2, 3, 5, 40, 400}) {
    for (const bool closed : {false, true}) {
      if (closed && count < 3) continue;
      const auto points = walk(random, count, 0.3);
      const auto made = build(polyline(points, closed ? kClosed : ""));
      for (int i = 0; i < 100; ++i) {
        Rig rig(made);
        const Vec3 probe = random.box(2);
        ASSERT_NEAR(norm(probe - rig.tick(probe).proxy), brute_distance(points, closed, probe), 2e-15);
        ASSERT_LE(rig.state.residual, 1e-15);
        ASSERT_EQ(rig.state.status, LinkStatus::ok);
      }
    }
  }
}

TEST(Polyline, DoesNotJumpToANearerPart) {
  // a hairpin: two parallel parts 0.2 apart, joined far away
  const std::vector<Vec3> hairpin{{0, 0, 0}, {5, 0, 0}, {5, 0.2, 0}, {0, 0.2, 0}};
  Rig rig(build(polyline(hairpin)));
  rig.tick({1, -0.05, 0});
  for (int i = 0; i <= 300; ++i) {
    const Vec3 probe(1 + 0.01 * i, 0.19, 0);  // 0.01 from the other part
    ASSERT_TRUE(bitwise_equal(rig.tick(probe).proxy, Vec3(probe.x, 0, 0)));
  }
  // beyond the bend the local minimum vanishes
  expect_steps(
      rig, {
               {{5.1, 0.1, 0}, {}, {5, 0.1, 0}}, {{5.1, 0.3, 0}, {}, {5, 0.2, 0}}, {{4, 0.01, 0}, {}, {4, 0.2, 0}}  // now on the other part
           });
}

TEST(Polyline, HoldsAtCornersBitForBit) {
  Rig rig(build(polyline({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}})));
  EXPECT_TRUE(bitwise_equal(rig.tick({1.2, -0.3, 0.1}).proxy, Vec3(1, 0, 0)));
  EXPECT_EQ(rig.state.residual, 0);
  expect_steps(rig, {{{1.4, -1e-9, 0.1}, {}, {1, 0, 0}},
                     {{1.4, 0.25, 0.1}, {}, {1, 0.25, 0}},
                     {{0.25, -0.5, 0}, {}, {0.25, 0, 0}},
                     {{-3, 0, 0}, kOk, {0, 0, 0}},  // the open end
                     {{1, 7, 0}, {}, {1, 1, 0}}});
}

TEST(Polyline, LeavesACornerOnTheSteeperSide) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  for (const bool from_above : {false, true}) {
    Rig rig(build(polyline(points)));
    // the next step is the same from either side of the corner
    rig.tick(from_above ? Vec3(1, 0.5, 0) : Vec3(0.5, 0, 0));
    ASSERT_TRUE(bitwise_equal(rig.tick({1.1, -0.1, 0}).proxy, Vec3(1, 0, 0)));
    EXPECT_TRUE(bitwise_equal(rig.tick({0.5, 0.25, 0}).proxy, Vec3(0.5, 0, 0)));
    ASSERT_TRUE(bitwise_equal(rig.tick({1.1, -0.1, 0}).proxy, Vec3(1, 0, 0)));
    EXPECT_TRUE(bitwise_equal(rig.tick({0.75, 0.5, 0}).proxy, Vec3(1, 0.5, 0)));
  }
}

TEST(Polyline, AClosedPolylineWrapsAndIsRepeatable) {
  std::vector<Vec3> points;
  for (int i = 0; i < 24; ++i) points.emplace_back(std::cos(i * 0.2617993877991494), std::sin(i * 0.2617993877991494), 0.1 * (i % 2));
  Rig rig(build(polyline(points, kClosed)));
  std::vector<Vec3> first;
  Vec3 last(0.0);
  for (int lap = 0; lap < 4; ++lap) {
    const bool back = lap == 2;
    for (int k = 0; k < 1000; ++k) {
      const int i = back ? 999 - k : k;
      const Vec3 probe(1.5 * std::cos(i * 6.283185307179586e-3), 1.5 * std::sin(i * 6.283185307179586e-3), 0.05);
      rig.tick(probe);
      if (lap == 0) first.push_back(rig.state.proxy);
      ASSERT_TRUE(bitwise_equal(rig.state.proxy, first[static_cast<std::size_t>(i)])) << lap << " " << i;
      ASSERT_LE(norm(rig.state.proxy - last), lap + k > 0 ? 0.02 : 2);
      last = rig.state.proxy;
    }
  }
}

TEST(Polyline, OutsideAConvexPolylineTheProxyNeverMovesFurtherThanTheProbe) {
  Rig rig(build(polyline({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, kClosed)));
  const auto path = [](int i) { return Vec3(2 * std::cos(i * 2e-3), 2 * std::sin(i * 2e-3), 0.3 * std::sin(i * 1e-2)); };
  expect_no_jumps(rig, 7999, path, 1 + 1e-12);
}

TEST(Polyline, RepeatedPointsAreMerged) {
  const std::vector<Vec3> once{{0, 0, 0}, {1, 0, 0}, {1, 1, 1}},
      twice{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 1}, {1, 1, 1}};
  auto ring = once;
  ring.push_back(once.front());
  Rig a(build(polyline(once))), b(build(polyline(twice))), c(build(polyline(once, kClosed))), d(build(polyline(ring, kClosed)));
  Random random(2);
  for (int i = 0; i < 500; ++i) {
    const Vec3 probe = random.box(1.5);
    ASSERT_TRUE(bitwise_equal(a.tick(probe).proxy, b.tick(probe).proxy));
    ASSERT_TRUE(bitwise_equal(c.tick(probe).proxy, d.tick(probe).proxy));
  }
}

TEST(Polyline, ALongWalkTakesSeveralTicksAndArrives) {
  std::vector<Vec3> points;
  for (int i = 0; i <= 100000; ++i) points.emplace_back(i * 1e-4, 0, 0);
  Rig rig(build(polyline(points)));
  rig.tick({0, 0, 1});
  int ticks = 0;
  while (++ticks < 100 && rig.tick({9.99995, 0, 1}).status == LinkStatus::budget) continue;
  EXPECT_EQ(rig.state.status, LinkStatus::ok);
  EXPECT_NEAR(ticks, 100000.0 / 4096, 2);
  EXPECT_NEAR(rig.state.proxy.x, 9.99995, 1e-4);
  EXPECT_EQ(rig.tick({0.3, 0, 1}).status, LinkStatus::budget);
}

TEST(Polyline, SeekFindsTheClosestPointAnywhere) {
  Random random(3);
  const auto points = walk(random, 20000, 0.05);
  const auto made = build(polyline(points));
  Rig rig(made);
  rig.tick(random.box(1));
  for (int i = 0; i < 60; ++i) {
    const Vec3 probe = random.box(1);
    for (int k = 0; k < 2 || (rig.state.status == LinkStatus::budget && k < 200); ++k) made->seek(probe, rig.state, rig.scratch);
    ASSERT_NEAR(norm(probe - rig.state.proxy), brute_distance(points, false, probe), 1e-15);
    // the point found is then followed
    const Vec3 found = rig.state.proxy;
    ASSERT_TRUE(bitwise_equal(rig.tick(probe).proxy, found));
  }
}

TEST(Polyline, ASeekInterruptedByTheHandEnds) {
  Random random(4);
  const auto points = walk(random, 20000, 0.05);
  const auto made = build(polyline(points));
  Rig rig(made);
  rig.tick(random.box(1));
  Vec3 probe(0.0);
  for (int i = 0; i < 3000; ++i) {
    probe += random.box(0.001);
    made->seek(probe, rig.state, rig.scratch);
    ASSERT_TRUE(rig.state.status == LinkStatus::ok || rig.state.status == LinkStatus::budget);
  }
  for (int i = 0; i < 200; ++i) made->seek(probe, rig.state, rig.scratch);
  EXPECT_NEAR(norm(probe - rig.state.proxy), brute_distance(points, false, probe), 1e-15);
}

TEST(Polyline, ReleasesAndReArmsOnAnyPart) {
  const std::vector<Vec3> hairpin{{0, 0, 0}, {5, 0, 0}, {5, 3, 0}, {0, 3, 0}};
  Rig rig(build(polyline(hairpin, R"(, "release": 0.5)")));
  expect_steps(rig, {{{1, 0.49, 0}, kOk},
                     {{1, 0.5, 0}, kReleased},
                     {{1, 0.051, 0}, kReleased},
                     {{1, 2.949, 0}, kReleased},
                     {{1, 2.951, 0}, kOk, {1, 3, 0}}});
}

TEST(Polyline, APointFoundByAnUnfinishedSearchIsFollowed) {
  std::vector<Vec3> points;
  for (int i = 0; i < 50000; ++i) points.emplace_back(0.03 * std::cos(i * 1.2566e-4), 0.03 * std::sin(i * 1.2566e-4), 0);
  Rig rig(build(polyline(points, R"(, "release": 0.5)")));
  ASSERT_EQ(rig.tick({0.04, 0, 0}).status, LinkStatus::ok);
  ASSERT_EQ(rig.tick({1, 0, 0}).status, LinkStatus::released);
  // at the centre all points are equally near and within a tenth of release
  ASSERT_EQ(rig.tick({0, 0, 1e-9}).status, LinkStatus::ok);
  const Vec3 taken = rig.state.proxy;
  for (int i = 1; i < 50; ++i) {
    ASSERT_EQ(rig.tick({0, 0, 1e-9 * i}).status, LinkStatus::ok) << i;
    ASSERT_LE(norm(rig.state.proxy - taken), 1e-3);
  }
}

TEST(Polyline, FarProbesGiveTheExtremePoint) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, 2, 0.5}};
  for (const double far : {1e20, 1e160, 1e300}) {
    Rig rig(build(polyline(points)));
    EXPECT_TRUE(bitwise_equal(rig.tick(Vec3(0.1, 1, 0.2) * far).proxy, points[3])) << far;
    EXPECT_TRUE(bitwise_equal(rig.tick(Vec3(-1, -1, 0) * far).proxy, points[0])) << far;
    EXPECT_TRUE(bitwise_equal(rig.tick(Vec3(1, -0.2, 0) * far).proxy, points[1])) << far;
    EXPECT_EQ(rig.state.status, LinkStatus::ok);
  }
}

TEST(Polyline, ThePrimitiveIsALineAndAtACornerAPoint) {
  Rig rig(build(polyline({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}})));
  rig.tick({0.5, -0.1, 0});
  expect_primitive(rig, {0.25, -0.1, 0}, Primitive::Kind::line, {0.25, 0, 0}, {1, 0, 0});
  expect_primitive(rig, {1.1, -0.1, 0}, Primitive::Kind::point, {1, 0, 0});
  EXPECT_TRUE(bitwise_equal(rig.tick({0.5, -0.1, 0}).proxy, Vec3(0.5, 0, 0)));  // primitive() has not moved the proxy
}

TEST(Polyline, RefusesBadKeys) {
  expect_refused("{\"name\": \"a\", \"type\": \"polyline\",\n \"points\": [[0, 0, 0], [0, 0, 0]]}", 2, {});
  const std::string head = R"({"name": "a", "type": "polyline")";
  for (const std::string& bad : {head + "}", polyline({}), polyline({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}, kClosed),
                                 polyline({{0, 0, 0}, {1e-305, 0, 0}}), polyline({{-1e308, 0, 0}, {1e308, 0, 0}}),
                                 polyline({{0, 0, 0}, {1, 0, 0}}, R"(, "closed": 1)"), head + R"(, "points": [[0, 0], [1, 1]]})"})
    EXPECT_FALSE(try_build(bad)) << bad;
}

}  // namespace catena::haptics::tests::polyline_test
