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

namespace catena::geodesics {
namespace level_path_test {

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

}  // namespace level_path_test
}  // namespace catena::geodesics
