// SPDX-License-Identifier: MIT
#include "engine/geometry/geodesics/geodesics.h"

#include <gtest/gtest.h>

namespace catena::geodesics {
namespace shorten_path_test {

TEST(ShortenPath, ADetourInThePlaneBecomesStraight) {
  const std::vector<Vec3> path =
      shorten_path({{0, 0, 0}, {0, 3, 0}, {2, -2, 0}, {4, 1, 0}, {5, 0, 0}}, [](Vec3& p) { return p.z = 0, true; });
  ASSERT_EQ(path.size(), 129u);
  EXPECT_EQ(path.front(), Vec3(0, 0, 0));
  EXPECT_EQ(path.back(), Vec3(5, 0, 0));
  EXPECT_NEAR(path_length(path), 5, 1e-6);
  for (std::size_t i = 0; i < path.size(); ++i) EXPECT_NEAR(path[i].x, 5.0 * static_cast<double>(i) / 128, 0.02) << "evenly spaced";
}

TEST(ShortenPath, APathAroundACylinderKeepsItsDirection) {
  // Three quarters of a turn: the result is the helix, not the shorter path in the other direction.
  const auto put = [](Vec3& p) {
    const double r = std::hypot(p.x, p.y);
    if (!(r > 0)) return false;
    p.x /= r;
    p.y /= r;
    return true;
  };
  std::vector<Vec3> path;
  for (int i = 0; i <= 30; ++i) {
    const double a = 1.5 * 3.14159265358979323846 * i / 30;
    path.push_back({std::cos(a), std::sin(a), (i == 0 ? 0 : i == 30 ? 1 : 0.4)});
  }
  EXPECT_NEAR(path_length(shorten_path(path, put)), std::hypot(1.5 * 3.14159265358979323846, 1.0), 1e-3);
}

TEST(ShortenPath, AFailingProjectionKeepsThePath) {
  const std::vector<Vec3> path = shorten_path({{0, 0, 0}, {1, 1, 0}, {2, 0, 0}}, [](Vec3&) { return false; });
  EXPECT_NEAR(path_length(path), 2 * std::sqrt(2.0), 1e-12);
  EXPECT_EQ(path_length(shorten_path({{1, 1, 1}, {1, 1, 1}}, [](Vec3&) { return true; })), 0);
}

}  // namespace shorten_path_test
}  // namespace catena::geodesics
