// SPDX-License-Identifier: MIT
#include "engine/geometry/geodesics/geodesics.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <numbers>
#include <numeric>
#include <queue>

#include "engine/field/analytic/analytic.h"
#include "engine/field/grid/grid.h"
#include "tests/support/mesh_shapes.h"

namespace catena::geodesics::geodesics_test {

constexpr double kPi = std::numbers::pi;

field::ScalarFieldPtr formula(const char* name) { return field::make_analytic(name, {})->scalar; }
field::ScalarFieldPtr sampled(const char* name, int resolution) { return field::sample_on_grid(*formula(name), resolution, -2, 2); }

/// Shortest paths on a torus, independent of any surface mesh: Dijkstra's algorithm over the two angles, with steps in so many directions
/// that a path is at most 0.1 % too long (for a tube of 0.4).
class Torus {
 public:
  explicit Torus(double tube) : tube_(tube) {}
  static constexpr int kAround = 240, kAcross = 96, kReach = 10;
  static constexpr double kStepAround = 2 * kPi / kAround, kStepAcross = 2 * kPi / kAcross;
  Vec3 place(int around, int across) const {
    const double r = 1 + tube_ * std::cos(across * kStepAcross);
    return {r * std::cos(around * kStepAround), r * std::sin(around * kStepAround), tube_ * std::sin(across * kStepAcross)};
  }
  double distance(std::array<int, 2> from, std::array<int, 2> to) const {
    std::vector<double> best(kAround * kAcross, std::numeric_limits<double>::infinity());
    const auto index = [](int u, int v) { return static_cast<std::size_t>(u * kAcross + v); };
    using Entry = std::pair<double, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    best[index(from[0], from[1])] = 0;
    queue.push({0, index(from[0], from[1])});
    while (!queue.empty()) {
      const auto [length, at] = queue.top();
      queue.pop();
      if (length > best[at]) continue;
      if (at == index(to[0], to[1])) return length;
      const int u = static_cast<int>(at) / kAcross, v = static_cast<int>(at) % kAcross;
      for (int du = -kReach; du <= kReach; ++du)
        for (int dv = -kReach; dv <= kReach; ++dv) {
          if (std::gcd(du, dv) != 1) continue;
          const double r = 1 + tube_ * std::cos((v + 0.5 * dv) * kStepAcross);
          const double longer = length + std::hypot(r * du * kStepAround, tube_ * dv * kStepAcross);
          double& known = best[index((u + du + kAround) % kAround, (v + dv + kAcross) % kAcross)];
          if (longer >= known) continue;
          known = longer;
          queue.push({longer, index((u + du + kAround) % kAround, (v + dv + kAcross) % kAcross)});
        }
    }
    return 0;
  }

 private:
  double tube_;
};

TEST(LevelPath, EqualsTheReferenceOnATorus) {
  const Torus torus(0.4);
  const field::ScalarFieldPtr by_formula = formula("torus"), by_grid = sampled("torus", 129);
  // Pairs across the tube, around the hole on the inside and the outside, and mixed.
  const std::array<std::array<std::array<int, 2>, 2>, 6> pairs{{{{{0, 0}, {0, 40}}},
                                                                {{{0, 48}, {90, 48}}},
                                                                {{{0, 0}, {50, 0}}},
                                                                {{{0, 0}, {110, 8}}},
                                                                {{{10, 16}, {80, 60}}},
                                                                {{{0, 0}, {60, 48}}}}};
  for (const auto& [from, to] : pairs) {
    const double expected = torus.distance(from, to);
    for (const field::ScalarFieldPtr& field : {by_formula, by_grid}) {
      const auto path = path_on_level(*field, 0.4, torus.place(from[0], from[1]), torus.place(to[0], to[1]));
      ASSERT_FALSE(path.empty());
      EXPECT_NEAR(path_length(path), expected, (field == by_grid ? 4e-3 : 2e-3) * expected)
          << from[0] << "," << from[1] << " " << to[0] << "," << to[1];
    }
  }
}

TEST(LevelPath, IsTheGreatCircleOnASampledSphere) {
  const field::ScalarFieldPtr ball = sampled("sphere", 129);
  for (const double degrees : {5.0, 60.0, 150.0, 180.0}) {
    const double angle = degrees * kPi / 180;
    const auto path = path_on_level(*ball, 1.2, {1.2, 0, 0}, 1.2 * Vec3(std::cos(angle), 0.6 * std::sin(angle), 0.8 * std::sin(angle)));
    ASSERT_FALSE(path.empty()) << degrees;
    EXPECT_NEAR(path_length(path), 1.2 * angle, 1e-3 * 1.2 * angle) << degrees;
  }
}

TEST(LevelPath, DisconnectedSurfacesHaveNoPath) {
  // Ends on different sheets, levels without a surface, and ends outside the domain.
  const field::ScalarFieldPtr ball = sampled("sphere", 33);
  EXPECT_TRUE(path_on_level(*ball, 50, {1, 0, 0}, {0, 1, 0}).empty()) << "no such level";
  EXPECT_TRUE(path_on_level(*ball, 1, {9, 0, 0}, {0, 1, 0}).empty()) << "an end outside the domain";
  EXPECT_TRUE(path_on_level(*ball, 1, {std::nan(""), 0, 0}, {0, 1, 0}).empty());
  EXPECT_TRUE(path_on_level(*formula("constant"), 1, {0, 0, 0}, {0, 1, 0}).empty()) << "no surface at all";
  // The surface leaves the domain: eight corners of a sphere of radius 2.8 in the box -2..2.
  EXPECT_TRUE(path_on_level(*ball, 3, {1.8, 1.8, 1.8}, {-1.8, -1.8, -1.8}).empty());
  EXPECT_FALSE(path_on_level(*ball, 3, {1.8, 1.8, 1.8}, {1.8, 1.9, 1.7}).empty());
}

TEST(LevelPath, IsStraightOnAPlane) {
  const auto path = path_on_level(*formula("plane"), 0.25, {-1, -1, 0.3}, {1.5, 1, 0.2});
  ASSERT_FALSE(path.empty());
  EXPECT_NEAR(path_length(path), norm(Vec3(2.5, 2, 0)), 1e-6);
}

TEST(MeshPath, IsTheGreatCircleOnASphere) {
  const mesh::MeshPtr ball = *mesh::make_mesh(test::sphere_soup(24), "ball");
  for (const double angle : {0.1, 0.5, 1.5, 3.0}) {
    const auto path = path_on_mesh(*ball, {1, 0, 0}, Vec3(std::cos(angle), 0.28 * std::sin(angle), 0.96 * std::sin(angle)));
    ASSERT_FALSE(path.empty()) << angle;
    EXPECT_NEAR(path_length(path), angle, 4e-3 * angle) << "the mesh lies within the sphere by 1e-3";
  }
}

TEST(MeshPath, IsStraightOnTheUnfoldedFacesOfABox) {
  const mesh::MeshPtr box = *mesh::make_mesh(test::box_soup(), "box");
  EXPECT_NEAR(path_length(path_on_mesh(*box, {0.5, 0, 0}, {0, 0.5, 0})), 1, 1e-2);
  EXPECT_NEAR(path_length(path_on_mesh(*box, {0.5, 0.1, -0.3}, {0.1, 0.5, 0.2})), std::hypot(0.4 + 0.4, 0.5), 1e-2);
  EXPECT_NEAR(path_length(path_on_mesh(*box, {0.5, -0.4, 0}, {0.5, 0.3, 0.1})), std::hypot(0.7, 0.1), 1e-6) << "on one face";
}

TEST(MeshPath, DisconnectedPiecesHaveNoPath) {
  mesh::TriangleSoup soup;
  test::add_box(soup, Vec3(-0.5), Vec3(0.5));
  test::add_box(soup, {2, -0.5, -0.5}, {3, 0.5, 0.5});
  const mesh::MeshPtr two = *mesh::make_mesh(soup, "two");
  EXPECT_TRUE(path_on_mesh(*two, {0, 0, 0.5}, {2.5, 0, 0.5}).empty());
  EXPECT_FALSE(path_on_mesh(*two, {2.2, 0, 0.5}, {2.5, 0, 0.5}).empty());
  EXPECT_TRUE(path_on_mesh(*two, {std::nan(""), 0, 0.5}, {2.5, 0, 0.5}).empty());
}

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
    const double a = 1.5 * kPi * i / 30;
    path.push_back({std::cos(a), std::sin(a), (i == 0 ? 0 : i == 30 ? 1 : 0.4)});
  }
  EXPECT_NEAR(path_length(shorten_path(path, put)), std::hypot(1.5 * kPi, 1.0), 1e-3);
}

TEST(ShortenPath, AFailingProjectionKeepsThePath) {
  const std::vector<Vec3> path = shorten_path({{0, 0, 0}, {1, 1, 0}, {2, 0, 0}}, [](Vec3&) { return false; });
  EXPECT_NEAR(path_length(path), 2 * std::sqrt(2.0), 1e-12);
  EXPECT_EQ(path_length(shorten_path({{1, 1, 1}, {1, 1, 1}}, [](Vec3&) { return true; })), 0);
}

}  // namespace catena::geodesics::geodesics_test
