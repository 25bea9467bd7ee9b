// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/curve.h"

#include <gtest/gtest.h>

#include <random>

#include "engine/field/callable_field.h"
#include "tests/engine/geometry/flow/lambda_field.h"

namespace catena::flow::curve_test {

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
  for (const auto& [s, interval] : {std::pair{-5.0, 0u}, {0.0, 0u}, {1.58, 1u}, {100.0, 3u}}) EXPECT_EQ(curve.find_interval(s), interval);
}

TEST(Curve, TerminationsHaveTheirNames) {
  EXPECT_STREQ(to_string(Termination::boundary), "BOUNDARY");
  EXPECT_STREQ(to_string(Termination::critical), "CRITICAL");
  EXPECT_STREQ(to_string(Termination::length), "LENGTH");
  EXPECT_STREQ(to_string(Termination::lap), "LAP");
}

CurvePtr traced(const field::VectorFieldPtr& field, const Vec3& seed, double length = 0) {
  const Flow flow{field.get(), false, 0};
  TraceOptions options;
  options.length = length;
  auto curve = trace(flow, seed, options);
  CATENA_ASSERT(static_cast<bool>(curve));
  return *curve;
}

Vec3 somewhere(std::mt19937_64& random, double half) {
  const auto one = [&] { return half * (2 * static_cast<double>(random() >> 11) * 0x1p-53 - 1); };
  const double x = one(), y = one(), z = one();
  return {x, y, z};
}

TEST(NearestOnCurve, EqualsTheProjectionOntoACircle) {
  const CurvePtr curve = traced(test::analytic_vector("circle"), {0.5, 0, 0});
  const NearestOnCurve nearest(curve);
  std::mt19937_64 random(3);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 x = somewhere(random, 2);
    const NearestPoint found = nearest.find(x);
    const double r = std::sqrt(x.x * x.x + x.y * x.y);
    const double truth = std::sqrt((r - 0.5) * (r - 0.5) + x.z * x.z);
    EXPECT_NEAR(std::sqrt(found.distance2), truth, 5e-11);
    EXPECT_LE(norm(curve->position(found.s) - Vec3(0.5 * x.x / r, 0.5 * x.y / r, 0)), 2e-8 / std::max(0.01, r));
    EXPECT_LE(found.work, kMaxNearestWork + 8);
  }
}

TEST(NearestOnCurve, AgreesWithAScanOfAllKnots) {
  // Lines of the ABC flow wind through the whole box: many local minima.
  const CurvePtr curve = traced(test::analytic_vector("abc"), {0.1, 0.2, 0.3}, 40);
  const NearestOnCurve nearest(curve);
  ASSERT_GT(curve->knots().size(), 1500u);
  std::mt19937_64 random(4);
  int most = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 x = somewhere(random, 8);
    double scan = 1e300;
    for (std::size_t k = 0; k + 1 < curve->knots().size(); ++k)
      for (int j = 0; j < 4; ++j) {
        const double s = curve->knots()[k].s + (curve->knots()[k + 1].s - curve->knots()[k].s) * 0.25 * j;
        scan = std::min(scan, norm(x - curve->position(s)));
      }
    const NearestPoint found = nearest.find(x);
    EXPECT_LE(std::sqrt(found.distance2), scan + 1e-12);
    EXPECT_GE(std::sqrt(found.distance2), scan - 5e-3);
    EXPECT_GE(found.s, curve->knots()[found.interval].s);
    EXPECT_LE(found.s, curve->knots()[found.interval + 1].s);
    most = std::max(most, found.work);
  }
  EXPECT_LT(most, kMaxNearestWork);
}

/// A line that winds 4,000 times around a torus: hundreds of its passes are near any position.
TEST(NearestOnCurve, ExactFindsTheNearestOfHundredsOfPasses) {
  const field::VectorFieldPtr winding =
      field::make_callable_field("winding", {Vec3(-2.0), Vec3(2.0)}, field::VectorFunction([](const Vec3& p) {
                                   const double r = std::hypot(p.x, p.y), out = r - 1;
                                   return Vec3(-p.y / r - 7.3 * p.z * p.x / r, p.x / r - 7.3 * p.z * p.y / r, 7.3 * out);
                                 }));
  const CurvePtr curve = traced(winding, {1.4, 0, 0}, 5000);
  const NearestOnCurve nearest(curve);
  double bounded = 0;
  int most = 0;
  for (std::size_t k = 0; k < curve->knots().size(); k += 1501) {
    const NearestPoint found = nearest.find_exact(curve->knots()[k].p);
    EXPECT_EQ(found.distance2, 0);
    most = std::max(most, found.work);
    bounded = std::max(bounded, nearest.find(curve->knots()[k].p).distance2);
  }
  EXPECT_GT(bounded, 0);  // ensures that the case is tested
  EXPECT_GT(most, kMaxNearestWork);
}

TEST(NearestOnCurve, WorkIsBoundedIfAllPointsAreEquallyNear) {
  const NearestOnCurve nearest(traced(test::analytic_vector("circle"), {0.5, 0, 0}));
  for (const Vec3& x : {Vec3(0.0), Vec3(0, 0, 1), Vec3(0, 0, 1e100), Vec3(1e100, 0, 0)}) {
    const NearestPoint found = nearest.find(x);
    EXPECT_LE(found.work, kMaxNearestWork + 8);
    EXPECT_TRUE(std::isfinite(found.s));
  }
}

}  // namespace catena::flow::curve_test
