// SPDX-License-Identifier: MIT
#include "engine/geometry/curves/robust_bounds.h"

#include <gtest/gtest.h>

#include <random>

namespace catena::curves::robust_bounds_test {

TEST(RobustBounds, SpreadPointsHaveNoOutliers) {
  std::mt19937 random(5);
  std::normal_distribution<float> bell(3, 2);
  std::uniform_real_distribution<float> even(-1, 1);
  std::vector<glm::vec3> normal, box, flat;
  for (int k = 0; k < 20000; ++k) {
    normal.emplace_back(bell(random), bell(random), bell(random));
    box.emplace_back(even(random), 20 * even(random), even(random));
    flat.emplace_back(even(random), even(random), 0.1f * even(random));
  }
  for (const auto& points : {normal, box, flat}) EXPECT_EQ(compute_robust_bounds(points).outliers, 0u);
}

TEST(RobustBounds, AFewDistantPointsAreLeftOut) {
  std::vector<glm::vec3> points;
  for (int k = 0; k < 100; ++k) points.emplace_back(k % 10, k / 10, 0);
  for (const float far : {50.0f, -1e6f, 1e14f}) points.emplace_back(far, 0, 0);
  points.emplace_back(0, 0, 40);
  const RobustBounds core = compute_robust_bounds(points);
  EXPECT_EQ(core.outliers, 4u);
  EXPECT_EQ(core.box.lo, Vec3(0, 0, 0));
  EXPECT_EQ(core.box.hi, Vec3(9, 9, 0));
}

TEST(RobustBounds, WithoutASpreadAllPointsAreIncluded) {
  EXPECT_TRUE(compute_robust_bounds({}).box.empty());
  std::vector<glm::vec3> points(100, glm::vec3(1));
  points.emplace_back(7, 1, 1);
  EXPECT_EQ(compute_robust_bounds(points).outliers, 0u);
  EXPECT_EQ(compute_robust_bounds(points).box.hi.x, 7);
  const std::vector<glm::vec3> three{{0, 0, 0}, {1, 0, 0}, {100, 0, 0}};
  EXPECT_EQ(compute_robust_bounds(three).outliers, 0u);
}

}  // namespace catena::curves::robust_bounds_test
