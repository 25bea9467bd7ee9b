// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/derivatives.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/engine/geometry/flow/lambda_field.h"

namespace catena::flow::derivatives_test {

Mat3 shear() { return Mat3(Vec3(0.3, -1, 0.2), Vec3(2, 0.1, -0.5), Vec3(0.7, 0.4, -0.4)); }  // columns dv/dx_j
Vec3 linear(const Vec3& p) { return Vec3(0.5, -0.2, 1) + shear() * p; }

void expect_near(const VelocityGradient& found, const Vec3& v, const Mat3& gradient, double tolerance) {
  ASSERT_TRUE(found.is_valid);
  EXPECT_LE(norm(found.v * found.scale - v), tolerance);
  for (int j = 0; j < 3; ++j) EXPECT_LE(norm(found.gradient[j] * found.scale - gradient[j]), tolerance) << j;
}

TEST(VelocityGradient, IsExactForALinearFieldOnAnyGrid) {
  const auto tilted = field::Mapping::from_linear(Mat3(0.8, 0.6, 0.0, -0.3, 0.4, 0.2, 0.1, 0.05, 0.9), Vec3(-3, 7, -11));
  for (const field::Mapping& mapping : {field::Mapping{}, tilted}) {
    const auto grid = test::sample_vector_grid(mapping, {5, 6, 7}, linear);
    for (const Vec3& index : {Vec3(0.0), Vec3(1.3, 2.7, 4.9), Vec3(4, 5, 6), Vec3(2, 3, 3.5)}) {
      field::Cursor cursor;
      int evaluations = 0;
      const Vec3 p = mapping.world_from_index(index);
      const VelocityGradient found = compute_velocity_gradient(*grid, p, cursor, evaluations);
      if (!found.is_valid) continue;  // a corner, outside by rounding
      expect_near(found, linear(p), shear(), 2e-4);
      EXPECT_EQ(evaluations, 1);
    }
    EXPECT_EQ(velocity_gradient_fetches(*grid), 1);
  }
}

TEST(VelocityGradient, EqualsTheDerivativeOfTheTrilinearCell) {
  const auto grid =
      test::sample_vector_grid({}, {4, 4, 4}, [](const Vec3& p) { return Vec3(p.x * p.y * p.z, p.x * p.x, p.y - p.z * p.x); });
  field::Cursor cursor;
  int evaluations = 0;
  const Vec3 p(1.3, 0.6, 2.2);
  const VelocityGradient found = compute_velocity_gradient(*grid, p, cursor, evaluations);
  Mat3 gradient;
  for (int j = 0; j < 3; ++j) {
    Vec3 e(0.0);
    e[j] = 0.1;  // within the cell: exact along one axis
    gradient[j] = (grid->sample(p + e, cursor).value - grid->sample(p - e, cursor).value) * 5.0;
  }
  expect_near(found, grid->sample(p, cursor).value, gradient, 1e-12);
}

TEST(VelocityGradient, IsAccurateForFormulasAtAnyScale) {
  const auto exact = [](const Vec3& p) {
    const double a = std::sqrt(3.0), b = std::sqrt(2.0);
    return Mat3(Vec3(0, b * std::cos(p.x), -b * std::sin(p.x)), Vec3(-std::sin(p.y), 0, std::cos(p.y)),
                Vec3(a * std::cos(p.z), -a * std::sin(p.z), 0));
  };
  for (const double scale : {1e-300, 1.0, 1e300}) {
    const auto abc = test::analytic_vector("abc", scale);
    field::Cursor cursor;
    int evaluations = 0;
    const Vec3 p(0.3, -1.2, 0.8);
    VelocityGradient found = compute_velocity_gradient(*abc, p, cursor, evaluations);
    found.scale /= scale;
    expect_near(found, abc->sample(p, cursor).value * (1 / scale), exact(p), 2e-10);
    EXPECT_EQ(evaluations, 7);
    EXPECT_EQ(velocity_gradient_fetches(*abc), 7);
  }
  // The curl of the ABC flow equals the ABC flow.
  field::Cursor cursor;
  int evaluations = 0;
  const VelocityGradient found = compute_velocity_gradient(*test::analytic_vector("abc"), {0.5, 0.2, -0.7}, cursor, evaluations);
  EXPECT_LE(norm(curl(found.gradient) - found.v), 2e-10);
}

TEST(VelocityGradient, IsInvalidOutsideAndForNonFiniteValues) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto grid = test::sample_vector_grid({}, {4, 4, 4}, [&](const Vec3& p) { return p == Vec3(1, 1, 1) ? Vec3(0, nan, 0) : p; });
  field::Cursor cursor;
  int evaluations = 0;
  EXPECT_FALSE(compute_velocity_gradient(*grid, {-0.1, 1, 1}, cursor, evaluations).is_valid);
  EXPECT_FALSE(compute_velocity_gradient(*grid, {1e300, 1, 1}, cursor, evaluations).is_valid);
  EXPECT_FALSE(compute_velocity_gradient(*grid, {0.5, 0.5, 0.5}, cursor, evaluations).is_valid);
  EXPECT_TRUE(compute_velocity_gradient(*grid, {2.5, 2.5, 2.5}, cursor, evaluations).is_valid);
  EXPECT_FALSE(compute_velocity_gradient(*test::analytic_vector("circle"), {1e300, 1, 1}, cursor, evaluations).is_valid);
  const auto still = test::lambda_field([](const Vec3&) { return Vec3(0.0); });
  EXPECT_TRUE(compute_velocity_gradient(*still, {0, 0, 0}, cursor, evaluations).is_valid);
  EXPECT_EQ(compute_velocity_gradient(*still, {0, 0, 0}, cursor, evaluations).scale, 0);
}

}  // namespace catena::flow::derivatives_test
