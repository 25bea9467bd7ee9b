// SPDX-License-Identifier: MIT
#include "engine/field/line_field.h"

#include <gtest/gtest.h>

#include "tests/engine/field/field_helpers.h"

namespace catena::field::line_axis_test {

using test::Random;

/// Eigenvalues in descending order and the leading eigenvector by Jacobi rotations in long double: an independent reference.
struct Jacobi {
  long double values[3];
  Vec3 axis;
  explicit Jacobi(const Dyad& m) {
    long double a[3][3] = {{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}}, v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int sweep = 0; sweep < 40; ++sweep)
      for (int p = 0; p < 2; ++p)
        for (int q = p + 1; q < 3; ++q) {
          if (a[p][q] == 0) continue;
          const long double angle = 0.5L * std::atan2(2 * a[p][q], a[q][q] - a[p][p]), c = std::cos(angle), s = std::sin(angle);
          for (int k = 0; k < 3; ++k) {
            const long double x = a[k][p], y = a[k][q];
            a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
          }
          for (int k = 0; k < 3; ++k) {
            const long double x = a[p][k], y = a[q][k], w = v[k][p], z = v[k][q];
            a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
            v[k][p] = c * w - s * z, v[k][q] = s * w + c * z;
          }
        }
    int order[3] = {0, 1, 2};
    std::sort(order, order + 3, [&](int i, int j) { return a[i][i] > a[j][j]; });
    for (int i = 0; i < 3; ++i) values[i] = a[order[i]][order[i]];
    for (int i = 0; i < 3; ++i) axis[i] = static_cast<double>(v[i][order[0]]);
  }
  double coherence() const { return static_cast<double>((values[0] - values[1]) / (values[0] + values[1] + values[2])); }
};

TEST(LineField, IsTheLeadingEigenvectorOfTheDyads) {
  Random random(3);
  double worst_axis = 0, worst_rest = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    Dyad m;
    const int count = 1 + trial % 8;
    for (int n = 0; n < count; ++n) m.add(random.uniform(0, 1), random.in_box(Vec3(-1.0), Vec3(1.0)));
    const Jacobi truth(m);
    const LineAxis got = leading_axis(m);
    ASSERT_TRUE(is_finite(got.axis));
    if (truth.coherence() > 0.2) worst_axis = std::max(worst_axis, norm(cross(got.axis, truth.axis)));
    worst_rest = std::max(worst_rest, std::fabs(got.coherence - truth.coherence()));
    worst_rest = std::max(worst_rest, std::fabs(got.speed * got.speed - static_cast<double>(truth.values[0])));
  }
  EXPECT_LE(worst_axis, 2e-14);
  EXPECT_LE(worst_rest, 1e-7);  // near a double eigenvalue, the root is known to half the digits only
}

TEST(LineField, SignsOfTheCornersDoNotMatter) {
  Random random(4);
  for (int trial = 0; trial < 2000; ++trial) {
    std::array<Vec3, 8> corner, flipped;
    for (std::size_t c = 0; c < 8; ++c) {
      corner[c] = direction(Vec3(1, 0.2, 0) + 0.5 * random.in_box(Vec3(-1.0), Vec3(1.0)));
      flipped[c] = random.uniform(-1, 1) < 0 ? -corner[c] : corner[c];
    }
    const Vec3 f = random.in_box(Vec3(0.0), Vec3(1.0));
    const LineAxis a = line_axis(corner, f), b = line_axis(flipped, f);
    ASSERT_EQ(a.coherence, b.coherence);
    ASSERT_EQ(a.speed, b.speed);
    ASSERT_TRUE(a.axis == b.axis || a.axis == -b.axis);
  }
}

TEST(LineField, ANearlyPerpendicularTangentDoesNotCancelTheFibre) {
  // The corners nearly agree on +-(0, .97, -.2). If they were oriented along a perpendicular tangent, they would cancel.
  const Vec3 fibre = direction(Vec3(0, 0.97, -0.2));
  std::array<Vec3, 8> corner;
  for (std::size_t c = 0; c < 8; ++c) corner[c] = (c % 3 == 0 ? -1.0 : 1.0) * direction(fibre + Vec3(c % 2 == 0 ? 0.05 : -0.05, 0, 0));
  const LineAxis line = line_axis(corner, Vec3(0.4, 0.5, 0.6));
  EXPECT_GT(std::fabs(dot(line.axis, fibre)), 0.999);
  EXPECT_GT(line.coherence, 0.99);
  EXPECT_GT(line.speed, 0.99);
}

TEST(LineField, CoherenceIsLowWhereAxesDisagree) {
  std::array<Vec3, 8> corner;
  for (std::size_t c = 0; c < 8; ++c) corner[c] = (c & 1) ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  for (const double x : {0.0, 0.2, 0.45, 0.5, 0.7, 1.0}) {
    const LineAxis line = line_axis(corner, Vec3(x, 0.3, 0.8));
    EXPECT_NEAR(line.coherence, std::fabs(1 - 2 * x), 1e-7) << x;
    EXPECT_NEAR(line.speed, std::sqrt(std::max(x, 1 - x)), 1e-8) << x;
  }
  EXPECT_EQ(line_axis(std::array<Vec3, 8>{}, Vec3(0.5)).speed, 0);
  EXPECT_EQ(line_axis(std::array<Vec3, 8>{}, Vec3(0.5)).axis, Vec3(0.0));
}

TEST(LineField, AnyScaleGivesTheSameAxis) {
  Random random(5);
  for (int trial = 0; trial < 200; ++trial) {
    std::array<Vec3, 8> corner;
    for (Vec3& v : corner) v = direction(Vec3(1, 1, 0.3) + random.in_box(Vec3(-0.4), Vec3(0.4)));
    const Vec3 f = random.in_box(Vec3(0.0), Vec3(1.0));
    const LineAxis one = line_axis(corner, f);
    for (const double scale : {1e-300, 1e-160, 1e-20, 1e20, 1e160, 1e300}) {
      std::array<Vec3, 8> scaled = corner;
      for (Vec3& v : scaled) v *= scale;
      const LineAxis other = line_axis(scaled, f);
      ASSERT_LE(norm(other.axis - one.axis), 1e-14) << scale;
      ASSERT_NEAR(other.speed / scale, one.speed, 1e-12) << scale;
      ASSERT_NEAR(other.coherence, one.coherence, 1e-12) << scale;
    }
  }
}

}  // namespace catena::field::line_axis_test
