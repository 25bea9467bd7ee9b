// SPDX-License-Identifier: MIT
#include "tests/haptics/constraints/examples.h"

namespace catena::haptics::tests::curves_test {

/// Distance from line `k` by brute force over its segments.
double distance_to(const curves::CurveSet& set, std::size_t line, const Vec3& x) {
  double minimum = 1e300;
  for (std::uint32_t k = set.line_offsets[line]; k + 1 < set.line_offsets[line + 1]; ++k)
    minimum = std::min(minimum, norm(x - closest_on_segment(Vec3(set.points[k]), Vec3(set.points[k + 1]), x)));
  return minimum;
}
double distance_to(const curves::CurveSet& set, const Vec3& x) {
  double minimum = 1e300;
  for (std::size_t k = 0; k < set.line_count(); ++k) minimum = std::min(minimum, distance_to(set, k, x));
  return minimum;
}

Fields fields_with(const Polylines& lines) {
  Fields made;
  made.curves["fibres"] = make_curve_set(lines);
  return made;
}

TEST(CurvesLink, StartsAtTheClosestPointOfAllLines) {
  Random random(1);
  for (const int lines : {1, 2, 9, 300}) {
    const Fields fields = fields_with(random_fibers(lines, 1 + lines % 7 * 5 + 3, 0.05));
    const curves::CurveSet& set = *fields.curves.at("fibres");
    const auto made = build(R"({"name": "a", "type": "curves", "curves": "fibres"})", fields);
    for (int i = 0; i < 60; ++i) {
      Rig rig(made);
      const Vec3 probe = random.box(1.5);
      ASSERT_EQ(rig.tick(probe).status, LinkStatus::ok);
      ASSERT_NEAR(norm(probe - rig.state.proxy), distance_to(set, probe), 1e-14) << lines;
    }
  }
}

TEST(CurvesLink, RestrictedToOneLine) {
  Random random(2);
  const Fields fields = fields_with(random_fibers(40, 30, 0.05));
  const curves::CurveSet& set = *fields.curves.at("fibres");
  for (const std::size_t line : {std::size_t{0}, std::size_t{17}, std::size_t{39}}) {
    Rig rig(build(R"({"name": "a", "type": "curves", "curves": "fibres", "line": )" + std::to_string(line) + "}", fields));
    const Vec3 probe = random.box(1.5);
    EXPECT_NEAR(norm(probe - rig.tick(probe).proxy), distance_to(set, line, probe), 1e-14);
  }
}

// two lines that cross in projection: a hand that follows the first stays on it, although the other is nearer for a while
TEST(CurvesLink, FollowsTheHeldLine) {
  std::vector<Vec3> along, across;
  for (int i = 0; i <= 100; ++i) {
    along.push_back({-1 + 0.02 * i, 0, 0});
    across.push_back({0, -1 + 0.02 * i, 0.05});
  }
  const Fields fields = fields_with({along, across});
  Rig rig(build(R"({"name": "a", "type": "curves", "curves": "fibres", "snap": 0.1, "release": 0.3})", fields));
  int held = 0;
  for (int k = 0; k <= 1000; ++k) {
    const Vec3 probe(-0.9 + 0.0018 * k, 0.01, 0.04);
    rig.tick(probe);
    if (rig.state.released) continue;
    ++held;
    EXPECT_EQ(rig.state.proxy.y, 0) << k;
    EXPECT_NEAR(rig.state.proxy.x, probe.x, 1e-6) << k;
  }
  EXPECT_GE(held, 1000);
  // pulled away it is released, and snaps to the other line near it
  EXPECT_TRUE(rig.tick({0.5, 0.6, 0.4}).released);
  EXPECT_FALSE(rig.tick({0.03, 0.6, 0.06}).released);
  EXPECT_EQ(rig.state.proxy.x, 0);
}

// work of one tick, and the closest point after a few ticks, in a tractogram of 10^5 fibres
TEST(CurvesLink, AHundredThousandFibresFitTheWorkLimitOfATick) {
  const Fields fields = fields_with(random_fibers(100000, 20, 0.01));
  const curves::CurveSet& set = *fields.curves.at("fibres");
  Random random(3);
  Rig rig(build(R"({"name": "a", "type": "curves", "curves": "fibres", "snap": 0.05, "release": 0.06})", fields));
  int held = 0, waited = 0, maximum = 0;
  for (int hop = 0; hop < 40; ++hop) {
    const Vec3 from = random.box(0.9), way = random.box(0.2);
    for (int k = 0; k < 100; ++k) {
      rig.tick(from + way * (0.01 * k));
      maximum = std::max(maximum, rig.state.work());
      held += rig.state.released ? 0 : 1;
      waited += rig.state.status == LinkStatus::budget ? 1 : 0;
    }
  }
  EXPECT_LE(maximum, kMaxWork);
  EXPECT_GT(held, 2000);
  EXPECT_LT(waited, 400) << "a search is mostly through in its first ticks";
  for (int i = 0; i < 20; ++i) {
    Rig fresh(build(R"({"name": "a", "type": "curves", "curves": "fibres"})", fields));
    const Vec3 probe = random.box(1);
    fresh.arrive(probe, 7);
    EXPECT_NE(fresh.state.status, LinkStatus::budget);
    EXPECT_NEAR(norm(probe - fresh.state.proxy), distance_to(set, probe), 1e-14);
  }
}

TEST(CurvesLink, TwoLinksShareOneTree) {
  const Fields fields = fields_with(random_fibers(100, 20, 0.01));
  const std::string text = R"({"name": "a", "type": "curves", "curves": "fibres"})";
  const auto one = build(text, fields);
  const long held = fields.curves.at("fibres").use_count();
  const auto other = build(text, fields);
  EXPECT_EQ(fields.curves.at("fibres").use_count(), held) << "a second tree would hold the curves, too";
}

TEST(CurvesLink, ErrorsNameTheLineAndTheExpectation) {
  const Fields fields = fields_with(random_fibers(3, 20, 0.01));
  const std::string head = R"({"name": "a", "type": "curves")";
  expect_refused(head + "}", 1, {"\"curves\" is missing"}, fields);
  expect_refused(head + R"(, "curves": "fibre"})", 1, {"no curves fibre"}, fields);
  expect_refused(head + R"(, "curves": "fibres", "line": 3})", 1, {"expected"}, fields);
  EXPECT_TRUE(try_build(head + R"(, "curves": "fibres", "line": 2})", fields));
}

}  // namespace catena::haptics::tests::curves_test
