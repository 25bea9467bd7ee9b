// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/curve.h"

#include <gtest/gtest.h>

namespace catena::flow {
namespace curve_test {

/// Knots at every quarter of the unit circle.
std::vector<Knot> ring() {
  std::vector<Knot> knots;
  for (int i = 0; i <= 4; ++i) {
    const double a = i % 4 * M_PI / 2;
    knots.push_back({i * M_PI / 2, Vec3(std::cos(a), std::sin(a), 0.0), Vec3(-std::sin(a), std::cos(a), 0.0)});
  }
  knots[4].p = knots[0].p;
  knots[4].t = knots[0].t;
  return knots;
}

TEST(Curve, PassesThroughItsKnotsExactly) {
  const Curve curve(ring(), false, Termination::length, Termination::boundary, 4);
  for (std::size_t k = 0; k + 1 < curve.knots().size(); ++k) {
    Vec3 p, derivative;
    curve.evaluate_interval(k, curve.knots()[k].s, p, derivative);
    EXPECT_EQ(p, curve.knots()[k].p);
    EXPECT_LE(norm(derivative - curve.knots()[k].t), 1e-15);
    curve.evaluate_interval(k, curve.knots()[k + 1].s, p, derivative);
    EXPECT_EQ(p, curve.knots()[k + 1].p);
    EXPECT_EQ(derivative, curve.knots()[k + 1].t);
  }
  // The error of the cubic between knots is R (h/R)^4 / 384.
  EXPECT_NEAR(norm(curve.position(M_PI / 4)), 1, 2e-2);
}

TEST(Curve, OpenCurvesClampAndClosedOnesWrap) {
  const Curve open(ring(), false, Termination::length, Termination::boundary, 4),
      closed(ring(), true, Termination::lap, Termination::lap, 4);
  EXPECT_EQ(open.position(-1), open.knots().front().p);
  EXPECT_EQ(open.position(1e300), open.knots().back().p);
  EXPECT_NEAR(closed.period(), 2 * M_PI, 1e-15);
  for (const double s : {0.3, 2.0, 5.9}) {
    EXPECT_LE(norm(closed.position(s + 3 * closed.period()) - closed.position(s)), 1e-14);
    EXPECT_LE(norm(closed.position(s - closed.period()) - closed.position(s)), 1e-14);
  }
}

TEST(Curve, FindsTheIntervalOfAnArcLength) {
  const Curve curve(ring(), false, Termination::length, Termination::boundary, 4);
  EXPECT_EQ(curve.find_interval(-5), 0u);
  EXPECT_EQ(curve.find_interval(0), 0u);
  EXPECT_EQ(curve.find_interval(1.58), 1u);
  EXPECT_EQ(curve.find_interval(100), 3u);
}

TEST(Curve, TerminationsHaveTheirNames) {
  EXPECT_STREQ(to_string(Termination::boundary), "BOUNDARY");
  EXPECT_STREQ(to_string(Termination::critical), "CRITICAL");
  EXPECT_STREQ(to_string(Termination::length), "LENGTH");
  EXPECT_STREQ(to_string(Termination::lap), "LAP");
}

}  // namespace curve_test
}  // namespace catena::flow
