// SPDX-License-Identifier: MIT
// Isosurface links on cubic grids: closest point, normal, and the domain's walls. Compared with the field's own samples, with closed
// forms (cubic interpolation reproduces planes and paraboloids exactly) and with linear cells.
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::isosurface_cubic_test {

std::shared_ptr<const field::ScalarGrid> cubic_of(const field::ScalarGrid* grid) {
  auto made = grid->as_cubic();
  EXPECT_TRUE(made) << (made ? "" : made.error().message);
  return *made;
}
std::shared_ptr<const field::ScalarGrid> cubic_of(const std::shared_ptr<const field::ScalarGrid>& grid) { return cubic_of(grid.get()); }

struct Case {
  const char* name;
  double level;
  int resolution;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name << " " << c.resolution; }

class CubicIsosurface : public testing::TestWithParam<Case> {
 protected:
  /// Counts a proxy that is off the level, or not the closest point locally.
  void count(const Vec3& probe, const LinkState& state) {
    const SurfaceCheck j = check_on_surface(*grid, GetParam().level, probe, state.proxy);
    const bool good = state.status == LinkStatus::ok && j.off_level <= 1e-9 && j.tangential <= 1e-6;
    tally.add(state, !good, j.off_level, j.tangential);
  }
  const std::shared_ptr<const field::ScalarGrid> grid = cubic_of(sampled_field(GetParam().name, GetParam().resolution)->grid());
  const ConstraintPtr constraint = isosurface(grid, GetParam().level);
  SurfaceTally tally;
};

TEST_P(CubicIsosurface, ReachesTheClosestPointFromAnyStart) {
  const auto exact = isosurface(analytic_field(GetParam().name), GetParam().level);
  Random random(11);
  int farther = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 probe = random.box(1.6);
    Rig rig(constraint), true_one(exact);
    rig.arrive(probe);
    count(probe, rig.state);
    true_one.tick(probe);
    farther += norm(probe - rig.state.proxy) > norm(probe - true_one.state.proxy) + 1e-3;
  }
  EXPECT_LE(tally.bad, tally.runs / 500) << tally.text();
  EXPECT_LE(farther, tally.runs / 500);
}

TEST_P(CubicIsosurface, FollowsAWalkingHand) {
  Rig rig(constraint);
  const double speed = 0.3 * grid->mapping().min_voxel_edge();
  Wanderer hand{Random(12), speed, 0.1 * speed, 1.6, Vec3(0.9, 0.3, 0.4)};
  rig.tick(hand.probe);
  for (int i = 0; i < 5000; ++i) {
    rig.tick(hand.step());
    count(hand.probe, rig.state);
  }
  EXPECT_LE(tally.bad, tally.runs / 1000) << tally.text();
}

INSTANTIATE_TEST_SUITE_P(Grids, CubicIsosurface,
                         testing::Values(Case{"torus", 0.4, 32}, Case{"torus", 0.4, 64}, Case{"sphere", 1, 32}, Case{"gaussian", 0.5, 48}),
                         [](const auto& test) { return std::string(test.param.name) + std::to_string(test.param.resolution); });

/// Maximum angle between the field's normal at the proxy and that of the sphere |x|, over random probes around it.
double normal_error(const field::ScalarFieldPtr& field, double radius) {
  Rig rig(isosurface(field, radius));
  Random random(14);
  double worst = 0;
  field::Cursor cursor;
  for (int i = 0; i < 400; ++i) {
    rig.arrive(random.unit() * (1.02 * radius));
    const Vec3 n = direction(field->sample(rig.state.proxy, cursor).gradient);
    worst = std::max(worst, norm(n - direction(rig.state.proxy)));
  }
  return worst;
}

TEST(CubicIsosurface, NormalErrorOfSpheresIsTwentyTimesSmallerThanLinear) {
  const auto linear = sampled_field("sphere", 64);
  const auto cubic = cubic_of(linear->grid());
  for (const double radius : {0.5, 0.8, 1.0, 1.25, 1.5}) {
    const double of_linear = normal_error(linear, radius), of_cubic = normal_error(cubic, radius);
    EXPECT_GT(of_linear, 20 * of_cubic) << radius;
  }
}

/// z - x / 10 - (x^2 + y^2) / 4, reproduced exactly.
double bowl(const Vec3& p) { return p.z - 0.1 * p.x - 0.25 * (p.x * p.x + p.y * p.y); }
/// A gentle slope: z = x / 10 at its level 0.
double slope(const Vec3& p) { return p.z - 0.1 * p.x; }

TEST(CubicWalls, TheProxySlidesOnTheDomainBoundaryAndReturns) {
  const auto linear = cube_grid(17, slope);
  for (const auto& grid : {linear, cubic_of(linear)}) {
    const bool cubic = grid != linear;
    Rig rig(isosurface(grid, 0));
    for (double x = 0; x < 3; x += 0.01) {
      ASSERT_LE(rig.tick({x, 0.33, 0.5}).proxy.x, 2 + 1e-12);
      // the closest point on the plane; beyond the wall the closest point on the edge
      const double foot = (x + 0.1 * 0.5) / 1.01;
      ASSERT_TRUE(std::fabs(foot - 2) < 1e-6 || rig.state.status == (foot < 2 ? LinkStatus::ok : LinkStatus::boundary)) << x;
      ASSERT_NEAR(rig.state.proxy.x, std::min(foot, 2.0), 1e-6) << x;
      ASSERT_NEAR(rig.state.proxy.y, 0.33, 1e-6) << x;
    }
    EXPECT_NEAR(rig.state.proxy.x, 2, cubic ? 1e-6 : 1e-12);
    EXPECT_NEAR(rig.state.proxy.z, 0.2, cubic ? 1e-9 : 1e-6);
    EXPECT_EQ(rig.state.reason, SampleStatus::outside_box);
    EXPECT_NEAR(rig.tick({3, -0.7, 0.5}).proxy.y, -0.7, 1e-6);
    rig.tick({3, 3, 0.5});  // the intersection of two walls
    EXPECT_NEAR(norm(rig.state.proxy - Vec3(2, 2, 0.2)), 0, 1e-6);
    EXPECT_EQ(rig.state.status, LinkStatus::boundary);
    EXPECT_EQ(rig.tick({1, 0, 0}).status, LinkStatus::ok);
  }
}

TEST(CubicWalls, OnACurvedSurfaceTheBoundaryIsACurve) {
  const auto grid = cubic_of(cube_grid(17, bowl));
  Rig rig(isosurface(grid, 0.5));
  // on x = 2: z = 1.7 + y^2 / 4; brute force over y
  for (double y = -1; y <= 1; y += 0.05) {
    const Vec3 probe(2.6, y, 2.2);
    rig.arrive(probe);
    double best = 1e9, at = 0;
    for (double t = -1.0954; t <= 1.0954; t += 1e-4) {  // the part below the box's top
      const double d = norm(probe - Vec3(2, t, 0.5 + 0.2 + 0.25 * (4 + t * t)));
      if (d < best) best = d, at = t;
    }
    ASSERT_EQ(rig.state.status, LinkStatus::boundary) << y;
    ASSERT_NEAR(rig.state.proxy.x, 2, 1e-9);
    ASSERT_NEAR(rig.state.proxy.y, at, 2e-4) << y;
    ASSERT_NEAR(bowl(rig.state.proxy), 0.5, 1e-7) << "the samples are floats";
  }
}

TEST(CubicWalls, ObliqueDomainsHaveWalls) {
  const auto mapping = field::Mapping::from_linear(Mat3(0.2, 0.05, 0, -0.04, 0.25, 0.02, 0.03, 0, 0.3), Vec3(-2.0));
  const auto grid = cubic_of(sample_scalar_grid(mapping, {17, 17, 17}, slope));
  const Vec3 from = mapping.world_from_index(Vec3(8.0)), out = mapping.world_from_index(Vec3(22, 8, 8));
  Rig rig(isosurface(grid, from.z - 0.1 * from.x));
  for (int k = 0; k <= 100; ++k) rig.tick(from + (k / 100.0) * (out - from));
  ASSERT_EQ(rig.state.status, LinkStatus::boundary);
  EXPECT_NEAR(mapping.index_from_world(rig.state.proxy).x, 16, 1e-8);
  // the residual has no component along the edge and points out of the wall
  const Vec3 n = direction(Vec3(-0.1, 0, 1)), wall = direction(mapping.world_from_index_gradient(Vec3(1, 0, 0)));
  const Vec3 edge = direction(cross(n, wall));
  EXPECT_NEAR(dot(out - rig.state.proxy, edge), 0, 1e-6);
  EXPECT_GT(dot(out - rig.state.proxy, wall), 0);
}

TEST(CubicWalls, MasksAndNonFiniteValuesAreWalls) {
  std::vector<std::uint8_t> valid;
  for (int i = 0; i < 17 * 17 * 17; ++i) valid.push_back(i % 17 <= 10);
  const auto masked = cube_grid(17, slope, valid), holed = cube_grid(17, [](const Vec3&p) { return p.x > 0.6 ? std::nan("") : slope(p); });
  for (const auto& [grid, reason] :
       {std::pair{cubic_of(masked), SampleStatus::masked}, {cubic_of(holed), SampleStatus::not_finite}, {masked, SampleStatus::masked}}) {
    Rig rig(isosurface(grid, 0));
    for (double x = -1; x < 1.5; x += 0.01) {
      ASSERT_TRUE(is_finite(rig.tick({x, 0.1 + 0.2 * x, 0.3}).proxy));
      ASSERT_LE(rig.state.proxy.x, 0.5 + 1e-12);
    }
    EXPECT_EQ(rig.state.status, LinkStatus::boundary);
    EXPECT_EQ(rig.state.reason, reason);
    EXPECT_NEAR(rig.state.proxy.x, 0.5, grid == masked ? 1e-9 : 1e-8);
    EXPECT_NEAR(rig.state.proxy.y, 0.1 + 0.2 * 1.49, 1e-6) << "it goes on along the wall";
    EXPECT_EQ(rig.tick({-0.5, 0, 0.1}).status, LinkStatus::ok);
  }
  // a start in the masked part finds the surface in the valid part
  Rig outside(isosurface(masked, 0));
  outside.tick({1.7, 0.1, 0.3});
  EXPECT_TRUE(is_finite(outside.tick({1.7, 0.1, 0.3}).proxy));
  EXPECT_TRUE(outside.state.status == LinkStatus::no_surface || outside.state.proxy.x <= 0.5 + 1e-9);
}

TEST(CubicWalls, TheSurfaceOfASliceIsACurve) {
  const auto grid = cubic_of(sample_scalar_grid(field::Mapping::from_linear(Mat3(0.25), Vec3(-2.0)), {17, 17, 1},
                                                [](const Vec3& p) { return p.y - 0.25 * p.x * p.x; }));
  Rig rig(isosurface(grid, 0));
  rig.arrive({1, 1, -2});
  const SurfaceCheck j = check_on_surface(*grid, 0, {1, 1, -2}, rig.state.proxy);
  EXPECT_LE(j.off_level, 1e-9);
  EXPECT_LE(j.tangential, 1e-6);
  EXPECT_NEAR(rig.state.proxy.z, -2, 1e-12);
}

}  // namespace catena::haptics::tests::isosurface_cubic_test
