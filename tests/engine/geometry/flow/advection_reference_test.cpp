// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/flow.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "engine/geometry/flow/runge_kutta.h"
#include "tests/engine/geometry/flow/advection_reference.h"
#include "tests/engine/geometry/flow/lambda_field.h"

namespace catena::flow::advection_reference_test {

using test::analytic_vector;
using test::lambda_field;

const double kInfinity = std::numeric_limits<double>::infinity();
constexpr Method kAll[] = {Method::linear, Method::euler, Method::rk2, Method::rk3, Method::rk4, Method::rkf34, Method::dp54};

Vec3 abc(const Vec3& p) {
  const double a = std::sqrt(3.0), b = std::sqrt(2.0), c = 1;
  return {a * std::sin(p.z) + c * std::cos(p.y), b * std::sin(p.x) + a * std::cos(p.z), c * std::sin(p.y) + b * std::cos(p.x)};
}

Vec3 advect_in_steps(const Flow& flow, Vec3 p, double t, int steps, Method method, double tolerance = kInfinity) {
  field::Cursor cursor;
  for (int i = 0; i < steps; ++i) p += advect(flow, p, t / steps, method, tolerance, cursor).displacement;
  return p;
}

TEST(Advect, MethodNamesReadBack) {
  for (const Method m : kAll) EXPECT_EQ(parse_method(to_string(m)), m);
  EXPECT_FALSE(parse_method("rk5"));
}

TEST(Advect, TableausAreConsistent) {
  for (const Method m : kAll) {
    const Tableau& t = tableau_of(m);
    double b = 0, e = t.e_last;
    for (int i = 0; i < t.stages; ++i) {
      b += t.b[i];
      e += t.e[i];
    }
    EXPECT_NEAR(b, 1, 1e-15) << to_string(m);
    EXPECT_NEAR(e, 0, 1e-15) << to_string(m);
  }
}

TEST(Advect, HasTheExpectedOrdersOnAbc) {
  const auto field = lambda_field(abc);
  const Flow flow{field.get()};
  const Vec3 start(0.3, -0.7, 0.4);
  const Vec3 reference = advect_in_steps(flow, start, 1.0, 4000, Method::dp54);
  const struct {
    Method method;
    int order, steps;
  } cases[] = {{Method::linear, 1, 4000}, {Method::euler, 1, 4000}, {Method::rk2, 2, 400}, {Method::rk3, 3, 160},
               {Method::rkf34, 3, 160},   {Method::rk4, 4, 80},     {Method::dp54, 5, 40}};
  for (const auto& c : cases) {
    const double coarse = norm(advect_in_steps(flow, start, 1.0, c.steps, c.method) - reference);
    const double fine = norm(advect_in_steps(flow, start, 1.0, 2 * c.steps, c.method) - reference);
    EXPECT_NEAR(std::log2(coarse / fine), c.order, 0.1) << to_string(c.method);
  }
}

TEST(Advect, BackwardEqualsReversedFieldBitForBit) {
  const auto forward = lambda_field(abc);
  const auto backward = lambda_field([](const Vec3& p) { return -abc(p); });
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-3, 3), step(-1.5, 1.5);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p(place(random), place(random), place(random));
    const double dt = step(random);
    for (const Method m : kAll) {
      field::Cursor a, b;
      const Advected one = advect({forward.get()}, p, -dt, m, 1e-7, a), two = advect({backward.get()}, p, dt, m, 1e-7, b);
      EXPECT_EQ(std::memcmp(&one.displacement, &two.displacement, sizeof(Vec3)), 0) << to_string(m);
      EXPECT_EQ(one.evaluations, two.evaluations);
    }
  }
}

TEST(Advect, BackwardAdvectionReturnsToTheStart) {
  const auto field = lambda_field([](const Vec3& p) { return direction(abc(p)); });
  const Flow flow{field.get()};
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-3, 3);
  double worst_rkf = 0, worst_dp = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 p(place(random), place(random), place(random));
    for (const Method m : {Method::rkf34, Method::dp54}) {
      field::Cursor cursor;
      const Vec3 q = p + advect(flow, p, 1, m, 1e-9, cursor).displacement;
      const Vec3 back = q + advect(flow, q, -1, m, 1e-9, cursor).displacement;
      double& worst = m == Method::rkf34 ? worst_rkf : worst_dp;
      worst = std::max(worst, norm(back - p));
    }
  }
  RecordProperty("rkf34", std::to_string(worst_rkf));
  EXPECT_LE(worst_rkf, 1e-6);
  EXPECT_LE(worst_dp, 2e-8);
  EXPECT_GT(worst_rkf, 0);
}

TEST(Advect, IsInvariantUnderTheFieldsScale) {
  for (const double scale : {1e-300, 1e-150, 1.0, 1e150, 1e300}) {
    const auto field = lambda_field([scale](const Vec3& p) { return scale * Vec3(-p.y, p.x, 0.0); });
    for (const Method m : {Method::rk4, Method::rkf34, Method::dp54}) {
      field::Cursor cursor;
      const Advected a = advect({field.get()}, Vec3(1.0, 0.0, 0.0), 0.125 / scale, m, 1e-12, cursor);
      EXPECT_NEAR(a.displacement.x, std::cos(0.125) - 1, 1e-6) << scale;
      EXPECT_NEAR(a.displacement.y, std::sin(0.125), 1e-6) << scale;
      EXPECT_TRUE(a.complete && a.inside);
    }
  }
}

TEST(Advect, EvaluationsAreCappedAndCounted) {
  const auto field = lambda_field(abc);
  field::Cursor cursor;
  const Advected capped = advect({field.get()}, Vec3(0.1), 100, Method::rkf34, 1e-12, cursor, 50);
  EXPECT_FALSE(capped.complete);
  EXPECT_LE(capped.evaluations, 50);
  EXPECT_EQ(advect({field.get()}, Vec3(0.1), 0.1, Method::euler, 1e-9, cursor).evaluations, 1);
  EXPECT_EQ(advect({field.get()}, Vec3(0.1), 0.1, Method::rk4, 1e-9, cursor).evaluations, 4);
}

TEST(Advect, StopsAtTheBoundaryAndHandlesNonFiniteValues) {
  const auto walled = lambda_field([](const Vec3&) { return Vec3(1.0, 0.0, 0.0); }, [](const Vec3& p) { return p.x <= 1; });
  field::Cursor cursor;
  const Advected a = advect({walled.get()}, Vec3(0.0), 5, Method::rkf34, 1e-9, cursor);
  EXPECT_FALSE(a.inside);
  EXPECT_LE(a.displacement.x, 1);
  EXPECT_NEAR(a.displacement.x, 1, 1e-9);
  for (const double bad : {std::nan(""), kInfinity, -kInfinity, 0.0, 1e-323}) {
    const auto field = lambda_field([bad](const Vec3& p) { return p.x > 0.5 ? Vec3(bad) : Vec3(1.0); });
    for (const Method m : kAll) {
      const Advected b = advect({field.get()}, Vec3(0.4), 0.3, m, 1e-9, cursor);
      EXPECT_TRUE(is_finite(b.displacement));
      const Advected c = advect({field.get()}, Vec3(0.7), 0.3, m, 1e-9, cursor);
      EXPECT_TRUE(is_finite(c.displacement));
    }
  }
  EXPECT_FALSE(advect({walled.get()}, Vec3(std::nan("")), 1, Method::rkf34, 1e-9, cursor).inside);
}

TEST(Advect, SpeedsUpToTheMinimumAreZero) {
  const auto field = lambda_field([](const Vec3&) { return Vec3(0.5, 0.0, 0.0); });
  field::Cursor cursor;
  EXPECT_EQ(advect({field.get(), false, 0.5}, Vec3(0.0), 1, Method::rk4, 1e-9, cursor).displacement, Vec3(0.0));
  EXPECT_NEAR(advect({field.get(), false, 0.4}, Vec3(0.0), 1, Method::rk4, 1e-9, cursor).displacement.x, 0.5, 1e-15);
}

}  // namespace catena::flow::advection_reference_test
