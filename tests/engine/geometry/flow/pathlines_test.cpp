// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/pathlines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/engine/geometry/flow/lambda_field.h"
#include "tests/support/results.h"

namespace catena::flow::pathlines_test {

using Velocity = std::function<Vec3(const Vec3&, double)>;

UnsteadyField formula(Velocity velocity, double size) {
  struct Formula : UnsteadyFormula {
    explicit Formula(Velocity v) : v_(std::move(v)) {}
    Vec3 velocity(const Vec3& x, double t) override { return v_(x, t); }
    Velocity v_;
  };
  UnsteadyField field;
  field.name = "formula";
  field.times = {0, 100};
  field.make_formula = [velocity] { return std::make_unique<Formula>(velocity); };
  field.box.extend(Vec3(-size));
  field.box.extend(Vec3(size));
  return field;
}

/// Steps of a velocity on n^3 nodes over [-1, 1]^3; `masked`: a node that is invalid in one step.
UnsteadyField series(const Velocity& velocity, std::vector<double> times, int n, int* loads = nullptr) {
  UnsteadyField field;
  field.name = "series";
  field.times = times;
  field.load = [=](std::size_t step) -> Result<field::VectorFieldPtr> {
    if (loads != nullptr) ++*loads;
    std::vector<float> xyz;
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          const Vec3 v = velocity(Vec3(i, j, k) * (2.0 / (n - 1)) - 1.0, times[step]);
          for (int a = 0; a < 3; ++a) xyz.push_back(static_cast<float>(v[a]));
        }
    const auto mapping = field::Mapping::from_linear(Mat3(2.0 / (n - 1)), Vec3(-1.0));
    return field::VectorFieldPtr(field::make_vector_grid("v", mapping, {n, n, n}, xyz));
  };
  return field;
}

CurvePtr path(const UnsteadyField& field, const Vec3& seed, double start, double end) {
  PathlineOptions options;
  options.start = start;
  options.end = end;
  return test::value_of(test::value_of(trace_pathlines(field, std::vector{seed}, options)).front());
}

/// Position by the classical Runge-Kutta method with fixed steps.
Vec3 integrate(const Velocity& v, Vec3 x, double t, double end, int steps) {
  const double h = (end - t) / steps;
  for (int i = 0; i < steps; ++i) {
    const double at = t + i * h;
    const Vec3 a = v(x, at), b = v(x + 0.5 * h * a, at + 0.5 * h), c = v(x + 0.5 * h * b, at + 0.5 * h), d = v(x + h * c, at + h);
    x += h / 6 * (a + 2.0 * b + 2.0 * c + d);
  }
  return x;
}

Vec3 unsteady_abc(const Vec3& p, double t) {
  const double a = 1 + 0.4 * std::sin(0.7 * t);
  return {a * std::sin(p.z) + 0.5 * std::cos(p.y), std::sin(p.x) + a * std::cos(p.z), 0.5 * std::sin(p.y) + std::cos(p.x)};
}

TEST(Pathlines, FollowsFormulasOfTime) {
  // x' = 1, y' = cos t: a sine
  const auto curve = path(formula([](const Vec3&, double t) { return Vec3(1, std::cos(t), 0); }, 20), {0, 0, 0}, 0, 6);
  for (std::size_t k = 0; k < curve->knots().size(); ++k) {
    const double t = curve->times()[k];
    ASSERT_NEAR(norm(curve->knots()[k].p - Vec3(t, std::sin(t), 0)), 0, 1e-9);
  }
  EXPECT_EQ(curve->times().back(), 6);
  EXPECT_EQ(curve->last_end(), Termination::time);
  double length = 0;  // of the sine
  for (int i = 0; i < 60000; ++i) length += 1e-4 * std::hypot(1, std::cos(1e-4 * (i + 0.5)));
  EXPECT_NEAR(curve->period(), length, 1e-8);
  const UnsteadyField abc = formula(unsteady_abc, 50);
  const Vec3 seed(0.3, -0.4, 0.2);
  const auto line = path(abc, seed, 1, 6);
  EXPECT_NEAR(norm(line->knots().back().p - integrate(unsteady_abc, seed, 1, 6, 20000)), 0, 1e-9);
  // backward in time from its end, it comes back (Eq. 4); s is negative
  const auto back = path(abc, line->knots().back().p, 6, 1);
  EXPECT_NEAR(norm(back->knots().front().p - seed), 0, 1e-8);
  EXPECT_NEAR(back->knots().front().s, -line->knots().back().s, 1e-8);
}

TEST(Pathlines, FollowsAParticleThatRests) {
  // it moves for t < 1 and t > 2, and turns back there
  const auto speed = [](double t) { return t < 1 ? (1 - t) : t > 2 ? -(t - 2) : 0.0; };
  const auto curve = path(formula([&](const Vec3&, double t) { return Vec3(speed(t), 0, 0); }, 2), {0, 0, 0}, 0, 3);
  EXPECT_NEAR(curve->period(), 1, 1e-9);
  EXPECT_NEAR(norm(curve->knots().back().p), 0, 1e-9);
  double arrives = 0, leaves = 3;
  for (std::size_t k = 0; k < curve->knots().size(); ++k) {
    ASSERT_NEAR(curve->knots()[k].p.x, curve->times()[k] < 1.5 ? curve->knots()[k].s : 1 - curve->knots()[k].s, 1e-9);
    if (std::fabs(curve->knots()[k].p.x - 0.5) > 1e-6) continue;
    arrives = std::max(arrives, curve->times()[k] < 1.5 ? curve->times()[k] : 0);
    leaves = std::min(leaves, curve->times()[k] > 1.5 ? curve->times()[k] : 3);
  }
  EXPECT_GT(arrives, 0.99);
  EXPECT_LT(leaves, 2.01);
}

TEST(Pathlines, FollowsCellsAndStepsOfASeries) {
  const std::vector<double> times{0, 0.3, 1, 1.2, 2};
  int loads = 0;
  const auto swirl = [](const Vec3& p, double t) {
    const double r = std::exp(-2 * dot(p, p));
    return Vec3(-p.y * (1 + t) * r + 0.1, p.x * (1 + t * t) * r, 0.2 * std::sin(3 * t + p.x));
  };
  const UnsteadyField field = series(swirl, times, 17, &loads);
  const Vec3 seed(0.31, -0.12, -0.2);
  const auto curve = path(field, seed, 0.1, 1.9);
  EXPECT_EQ(loads, 5);
  std::vector<field::VectorFieldPtr> steps;
  for (std::size_t i = 0; i < times.size(); ++i) steps.push_back(*field.load(i));
  std::vector<field::Cursor> cursors(times.size());
  const auto linear = [&](const Vec3& p, double t) {
    const std::size_t i = std::min<std::size_t>(std::upper_bound(times.begin(), times.end(), t) - times.begin(), times.size() - 1) - 1;
    const double w = (t - times[i]) / (times[i + 1] - times[i]);
    return (1 - w) * steps[i]->sample(p, cursors[i]).value + w * steps[i + 1]->sample(p, cursors[i + 1]).value;
  };
  EXPECT_NEAR(norm(curve->knots().back().p - integrate(linear, seed, 0.1, 1.9, 180000)), 0, 2e-9);
  // a velocity that is linear in space and quadratic in time is exact when interpolated by cubics in time
  UnsteadyField quadratic = series([](const Vec3& p, double t) { return Vec3(0.25 + 0.5 * t * t, 0.5 * p.x, -0.25 * t); }, times, 9);
  const auto exact = [](const Vec3& p, double t) { return Vec3(0.25 + 0.5 * t * t, 0.5 * p.x, -0.25 * t); };
  quadratic.is_cubic_in_time = true;
  for (const double from : {0.0, 0.5})
    EXPECT_NEAR(norm(path(quadratic, {-0.9, 0, 0}, from, 1.5)->knots().back().p - integrate(exact, {-0.9, 0, 0}, from, 1.5, 3000)), 0,
                1e-7);
  // it ends where it leaves the domain
  const auto gone = path(quadratic, {0.5, 0, 0}, 0, 2);
  EXPECT_EQ(gone->last_end(), LineEnd(Termination::boundary, SampleStatus::outside_box));
  EXPECT_NEAR(gone->knots().back().p.x, 1, 1e-13);
}

TEST(Pathlines, NamesWhatItCannotTrace) {
  UnsteadyField field = series([](const Vec3&, double) { return Vec3(0, 0, 1); }, {0, 1}, 5);
  PathlineOptions options;
  options.end = 1;
  const auto results = test::value_of(trace_pathlines(field, std::vector{Vec3(3, 0, 0), Vec3(0.0)}, options));
  EXPECT_EQ(results[0].error().message, "seed (3, 0, 0) is outside the domain of series at time 0");
  EXPECT_TRUE(results[1]);
  const auto load = field.load;
  const UnsteadyField other = series([](const Vec3&, double) { return Vec3(0, 0, 1); }, {0, 1}, 6);
  field.load = [&](std::size_t step) { return step == 0 ? load(0) : other.load(1); };
  EXPECT_EQ(trace_pathlines(field, std::vector{Vec3(0.0)}, options).error().message,
            "step 1 has other nodes than step 0; steps over the same nodes were expected");
}

TEST(Streaklines, HoldEveryReleasedParticle) {
  // v = (1, sin t, 0): the particle released at r is at (t - r, cos r - cos t)
  PathlineOptions options;
  options.end = 9;
  const auto wave = formula([](const Vec3&, double t) { return Vec3(1, std::sin(t), 0); }, 20);
  const auto wave_pieces = test::value_of(test::value_of(trace_streaklines(wave, std::vector{Vec3(0.0)}, options)).front());
  ASSERT_EQ(wave_pieces.size(), 1u);
  const Curve& curve = *wave_pieces.front();
  EXPECT_EQ(curve.times().front(), 9);
  EXPECT_EQ(curve.times().back(), 0);
  double worst = 0;
  for (std::size_t k = 0; k + 1 < curve.knots().size(); ++k) {
    const double r = curve.times()[k];
    ASSERT_NEAR(norm(curve.knots()[k].p - Vec3(9 - r, std::cos(r) - std::cos(9.0), 0)), 0, 1e-9);
    const Vec3 middle = curve.position(0.5 * (curve.knots()[k].s + curve.knots()[k + 1].s));
    worst = std::max(worst, std::fabs(middle.y - (std::cos(9 - middle.x) - std::cos(9.0))));
  }
  EXPECT_LT(worst, 2 * 40e-6);
  // in a uniform flow that turns its direction, particles leave the box through a side: the line has two ends at it
  const auto turning = series([](const Vec3&, double t) { return Vec3(std::cos(t), std::sin(t), 0); },
                              [] {
                                std::vector<double> times;
                                for (int i = 0; i <= 80; ++i) times.push_back(0.1 * i);
                                return times;
                              }(),
                              5);
  options.end = 6;
  const auto pieces = test::value_of(test::value_of(trace_streaklines(turning, std::vector{Vec3(0.3, 0, 0)}, options)).front());
  for (const CurvePtr& piece : pieces) {
    for (std::size_t k = 0; k < piece->knots().size(); ++k) {
      const double r = piece->times()[k];
      ASSERT_NEAR(norm(piece->knots()[k].p - Vec3(0.3 + std::sin(6.0) - std::sin(r), std::cos(r) - std::cos(6.0), 0)), 0, 2e-3);
    }
  }
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0]->last_end(), Termination::boundary);
  EXPECT_NEAR(max_abs(pieces[0]->knots().back().p), 1, 1e-4);
}

}  // namespace catena::flow::pathlines_test
