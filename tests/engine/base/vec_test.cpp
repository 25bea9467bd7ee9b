// SPDX-License-Identifier: MIT
#include "engine/base/vec.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace catena::vec_test {

TEST(Vec, NormAndDirectionAreAccurateOverTheRangeOfDoubles) {
  for (const double scale : {1e-323, 1e-300, 1e-150, 1.0, 1e150, 1e307}) {
    const Vec3 v = scale * Vec3(3, -4, 12);
    EXPECT_TRUE(scale < 1e-320 || std::fabs(norm(v) / scale - 13) <= 1e-14 * 13) << norm(v) / scale;
    EXPECT_NEAR(norm(direction(v)), 1, 1e-15);
    EXPECT_EQ(direction(-v), -direction(v));
  }
  EXPECT_EQ(norm(Vec3(0.0)), 0);
  EXPECT_EQ(direction(Vec3(0.0)), Vec3(0.0));
}

TEST(Vec, NonFiniteVectorsHaveANonFiniteNormAndNoDirection) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const double some[] = {0, -1, 1e200, inf, -inf, nan};
  for (const double x : some)
    for (const double y : some)
      for (const double z : some) {
        const Vec3 v(x, y, z);
        EXPECT_EQ(std::isfinite(norm(v)), is_finite(v)) << x << " " << y << " " << z;
        EXPECT_TRUE(is_finite(direction(v))) << x << " " << y << " " << z;
        EXPECT_TRUE(is_finite(v) || direction(v) == Vec3(0.0)) << x << " " << y << " " << z;
      }
}

constexpr double kPi = std::numbers::pi;

void expect_near(const Vec3& a, const Vec3& b, double tolerance) { EXPECT_LE(norm(a - b), tolerance) << a.x << " " << a.y << " " << a.z; }

// Directions over the sphere, and the axes.
std::vector<Vec3> directions() {
  std::vector<Vec3> out = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  for (int k = 0; k < 60; ++k) {
    const double z = (k + 0.5) / 30 - 1, r = std::sqrt(1 - z * z), turn = 2.399963 * k;
    out.push_back(direction({r * std::cos(turn), r * std::sin(turn), z}));
  }
  return out;
}

TEST(Rotation, RotatesLikeItsMatrix) {
  const Quat q = rotation_from_vector({0.3, -1.1, 0.7});
  const Mat3 m = glm::mat3_cast(q);
  for (const Vec3& v : directions()) expect_near(rotate(q, v), m * v, 2e-15);
  expect_near(rotate(rotation_from_vector({0, 0, kPi / 2}), {1, 0, 0}), {0, 1, 0}, 1e-15);  // right-handed
}

TEST(Rotation, LogInvertsExpUpToHalfATurn) {
  for (const Vec3& axis : directions())
    for (const double angle : {1e-300, 1e-17, 1e-9, 1e-3, 0.5, 1.5, 3.0, kPi - 1e-3, kPi - 1e-9}) {
      const Vec3 v = axis * angle;
      expect_near(rotation_vector(rotation_from_vector(v)), v, 3e-15 * std::min(1.0, 2 * angle));
      const Quat q = rotation_from_vector(v);
      expect_near(rotation_vector({-q.w, -q.x, -q.y, -q.z}), v, 3e-15 * std::min(1.0, 2 * angle));
    }
  // Beyond half a turn, the logarithm is the shorter rotation back.
  expect_near(rotation_vector(rotation_from_vector({0, 0, kPi + 0.25})), {0, 0, -(kPi - 0.25)}, 3e-15);
  EXPECT_EQ(rotation_vector(kIdentityRotation), Vec3(0.0));
  EXPECT_EQ(rotation_from_vector(Vec3(0.0)), kIdentityRotation);
}

TEST(Rotation, TheShortestArcRotatesOneDirectionOntoTheOther) {
  for (const Vec3& a : directions())
    for (const Vec3& b : directions()) {
      const Quat q = shortest_arc(a, b);
      expect_near(rotate(q, a), b, 3e-15);
      const Vec3 v = rotation_vector(q);
      EXPECT_NEAR(norm(v), 2 * std::atan2(norm(b - a), norm(a + b)), 3e-15);
      EXPECT_NEAR(dot(v, a), 0, 3e-15);
    }
}

TEST(Rotation, TheShortestArcIsAccurateNearZeroAndHalfATurn) {
  for (const Vec3& a : directions())
    for (const Vec3& other : directions()) {
      const Vec3 square = direction(cross(a, other));
      if (!(max_abs(square) > 0)) continue;
      for (const double e : {0.0, 1e-18, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3}) {
        const Vec3 near = direction(a + square * e), far = direction(square * e - a);
        expect_near(rotate(shortest_arc(a, near), a), near, 3e-15);
        expect_near(rotate(shortest_arc(a, far), a), far, 3e-15);
        EXPECT_NEAR(norm(rotation_vector(shortest_arc(a, near))), std::atan(e), 4e-16);
        EXPECT_NEAR(norm(rotation_vector(shortest_arc(a, far))), kPi - std::atan(e), 3e-15);
      }
    }
}

TEST(Rotation, InvalidInputIsTheIdentity) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const Quat& q : {Quat(0, 0, 0, 0), Quat(nan, 0, 0, 0), Quat(1, inf, 0, 0)}) EXPECT_EQ(normalized(q), kIdentityRotation);
  const Quat tiny = normalized({3e-320, 0, 4e-320, 0}), huge = normalized({3e307, 0, 4e307, 0});
  EXPECT_NEAR(tiny.w, 0.6, 1e-3);  // denormals have few digits
  EXPECT_NEAR(huge.y, 0.8, 1e-15);
  EXPECT_EQ(rotation_from_vector({inf, 0, 0}), kIdentityRotation);
}

}  // namespace catena::vec_test
