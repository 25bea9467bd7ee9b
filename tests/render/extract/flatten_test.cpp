// SPDX-License-Identifier: MIT
#include "render/extract/flatten.h"

#include <gtest/gtest.h>

#include <cmath>

namespace catena::render::flatten_test {

constexpr double kPi = 3.14159265358979323846;

flow::Curve circle(double radius, int knots, bool closed) {
  std::vector<flow::Knot> k;
  const double sweep = closed ? 2 * kPi : kPi;
  for (int i = 0; i <= knots; ++i) {
    const double a = sweep * i / knots;
    k.push_back({radius * a, {radius * std::cos(a), radius * std::sin(a), 1.0}, {-std::sin(a), std::cos(a), 0.0}});
  }
  if (closed) {
    k.back().p = k.front().p;
    k.back().t = k.front().t;
  }
  return flow::Curve(std::move(k), closed, flow::Termination::lap, flow::Termination::lap, 4);
}

double distance_to_polyline(const Vec3& p, const std::vector<Vec3>& line) {
  double best = 1e300;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Vec3 d = line[i + 1] - line[i];
    const double t = std::clamp(dot(p - line[i], d) / dot(d, d), 0.0, 1.0);
    best = std::min(best, norm(p - line[i] - t * d));
  }
  return best;
}

TEST(Flatten, ChordErrorStaysBelowTwoPercentOfTheRadius) {
  for (const int knots : {8, 64, 5000}) {
    const flow::Curve curve = circle(1, knots, false);
    const auto points = flatten(curve, {0.01});
    double worst = 0;
    for (int i = 0; i <= 2000; ++i) worst = std::max(worst, distance_to_polyline(curve.position(kPi * i / 2000), points));
    EXPECT_LE(worst, 0.02 * 0.01 * 1.001) << knots;
    EXPECT_LE(points.size(), 250u) << "dense knots are thinned out";
    EXPECT_GE(points.size(), 70u);
  }
}

TEST(Flatten, PointsLieOnTheHermiteCurve) {
  const flow::Curve curve = circle(1, 40, false);
  for (const Vec3& p : flatten(curve, {0.003})) {
    const double s = std::atan2(p.y, p.x);
    double best = 1e300;
    for (int i = -50; i <= 50; ++i) best = std::min(best, norm(curve.position(s + 1e-7 * i) - p));
    EXPECT_LE(best, 1e-7);
  }
  EXPECT_EQ(flatten(curve, {0.003}).front(), curve.knots().front().p);
  EXPECT_EQ(flatten(curve, {0.003}).back(), curve.knots().back().p);
}

TEST(Flatten, AClosedCurveEndsWhereItBegins) {
  const auto points = flatten(circle(2, 100, true), {0.02});
  EXPECT_EQ(points.front(), points.back());
  EXPECT_GT(points.size(), 30u);
}

TEST(Flatten, AStraightLineNeedsTwoPoints) {
  std::vector<flow::Knot> knots;
  for (int i = 0; i <= 300; ++i) knots.push_back({0.01 * i, {0.01 * i, 0.0, 5.0}, {1.0, 0.0, 0.0}});
  const auto points = flatten(flow::Curve(std::move(knots), false, flow::Termination::boundary, flow::Termination::boundary, 4), {0.01});
  EXPECT_LE(points.size(), 3u);
  EXPECT_EQ(points.back(), Vec3(3.0, 0.0, 5.0));
}

TEST(Flatten, TheNumberOfPointsIsCapped) {
  const auto points = flatten(circle(1, 1000, false), {1e-9, 0.02, 500});
  EXPECT_LE(points.size(), 501u);
  EXPECT_GE(points.size(), 100u);
}

}  // namespace catena::render::flatten_test
