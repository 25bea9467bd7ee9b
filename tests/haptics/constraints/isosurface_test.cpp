// SPDX-License-Identifier: MIT
// Isosurface links on formulas and sampled grids: closest points, convergence and evaluations. Figures are printed on failure.
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::isosurface_test {

constexpr double kOffAnalytic = 1e-11, kOffSampled = 1e-9, kTangential = 1e-6;  // fractions of L

struct Formula {
  const char* name;
  double level;
};
void PrintTo(const Formula& f, std::ostream* out) { *out << f.name << " at " << f.level; }

class AnalyticIsosurface : public testing::TestWithParam<Formula> {
 protected:
  void count(const Vec3& probe, const LinkState& state) {
    const SurfaceCheck j = check_on_surface(*field, GetParam().level, probe, state.proxy);
    const bool good = state.status == LinkStatus::ok && j.off_level <= kOffAnalytic && j.tangential <= kTangential;
    tally.add(state, !good, j.off_level, j.tangential);
  }
  const field::ScalarFieldPtr field = analytic_field(GetParam().name);
  const ConstraintPtr constraint = isosurface(field, GetParam().level);
  SurfaceTally tally;
};

TEST_P(AnalyticIsosurface, ReachesTheClosestPointFromAnyStart) {
  Random random(7);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 probe = random.box(2);
    count(probe, Rig(constraint).tick(probe));
  }
  EXPECT_EQ(tally.bad, 0) << tally.text();
}

TEST_P(AnalyticIsosurface, FollowsJumpsWithinTheTick) {
  Random random(8);
  Rig rig(constraint);
  rig.tick(random.box(1));
  for (int i = 0; i < 5000; ++i) {
    const Vec3 probe = random.box(1.5);
    count(probe, rig.tick(probe));
  }
  EXPECT_EQ(tally.bad, 0) << tally.text();
  EXPECT_LE(tally.evaluations.at_quantile(0.99), 32) << tally.text();
}

TEST_P(AnalyticIsosurface, AHandsMotionNeedsFewEvaluations) {
  Rig rig(constraint);
  Wanderer hand{Random(9), 2e-3, 2e-4, 1.7, Vec3(0.9, 0.3, 0.4)};
  rig.tick(hand.step());
  for (int i = 1; i < 4000; ++i) {
    rig.tick(hand.step());
    count(hand.probe, rig.state);
  }
  EXPECT_EQ(tally.bad, 0) << tally.text();
  EXPECT_LE(tally.evaluations.at_quantile(0.5), 3) << tally.text();
}

INSTANTIATE_TEST_SUITE_P(Formulas, AnalyticIsosurface,
                         testing::Values(Formula{"sphere", 1}, Formula{"torus", 0.4}, Formula{"gaussian", 0.5}, Formula{"tanh", 0.3},
                                         Formula{"tanh", 0.95}, Formula{"plane", 0.2}, Formula{"linear", 0.5}),
                         [](const auto& test) { return std::string(test.param.name) + std::to_string(test.index); });

TEST(Isosurface, TheProxyRestsWhileTheProbeRests) {
  for (const bool grid : {false, true}) {
    const auto f = grid ? sampled_field("sphere", 33, 4) : analytic_field("sphere");
    for (const double d : {0.1, 0.5, 0.9, 1.5, 2.5, 3.0, 5.0, 20.0}) {
      Rig rig(isosurface(f, 1));
      rig.tick(Vec3(1.2, 0.1, -0.3));
      rig.tick(direction(Vec3(1, 2, -0.5)) * d);
      const Vec3 after = rig.state.proxy;
      for (int i = 0; i < 50; ++i) {
        rig.tick(direction(Vec3(1, 2, -0.5)) * d);
        ASSERT_TRUE(bitwise_equal(rig.state.proxy, after)) << "d = " << d << ", grid " << grid << ", tick " << i;
      }
    }
  }
}

// negative control: Newton's method as printed (Eq. 5) fails where the safeguarded one does not
TEST(Isosurface, PlainNewtonFailsOnASteepProfile) {
  const auto f = analytic_field("tanh");
  field::Cursor cursor;
  int failed = 0;
  for (int i = 0; i < 100; ++i) {
    const double sign = i % 2 ? 1 : -1;
    Vec3 p(0.01 * i, 0, sign * (0.1 + 0.001 * i));
    for (int k = 0; k < 64; ++k) {
      const auto s = f->sample(p, cursor);
      const double square = dot(s.gradient, s.gradient);
      if (!(square > 0) || !is_finite(p)) break;
      p = p - s.gradient * (s.value / square);
    }
    failed += !(std::fabs(p.z) < 1e-6);
  }
  EXPECT_EQ(failed, 100);
}

/// Maximum feasible descent of |probe - p| at p over the adjoining cells, as a fraction of L. For grids with axis-aligned voxels.
double descent_left(const field::ScalarGrid& grid, const Vec3& proxy, const Vec3& probe) {
  const field::Mapping& m = grid.mapping();
  const Vec3 index = m.index_from_world(proxy);
  field::Cursor cursor;
  std::vector<int> bases[3];
  bool face[3];
  for (int a = 0; a < 3; ++a) {
    const double nearest = std::floor(index[a] + 0.5);
    face[a] = std::fabs(index[a] - nearest) < 1e-9;
    const int low = static_cast<int>(face[a] ? nearest - 1 : std::floor(index[a]));
    for (const int b : {low, low + 1})
      if ((b == low || face[a]) && b >= grid.index_box().lo[a] && b <= grid.index_box().hi[a] - 1) bases[a].push_back(b);
  }
  double maximum = 0;
  for (const int bx : bases[0])
    for (const int by : bases[1])
      for (const int bz : bases[2]) {
        const auto cell = grid.cell({bx, by, bz}, cursor);
        if (!cell.valid) continue;
        const Vec3 f = index - Vec3(bx, by, bz);
        const Vec3 g = m.world_from_index_gradient(cell.gradient(f));
        for (int held = 0; held < 8; ++held) {
          Vec3 n = g, e = probe - proxy;
          bool legal = true;
          for (int a = 0; a < 3; ++a) {
            if (!(held >> a & 1)) continue;
            legal = legal && face[a];
            n[a] = e[a] = 0;
          }
          n = direction(n);
          if (!legal || !(max_abs(n) > 0)) continue;
          Vec3 t = e - n * dot(n, e);
          if (held == 3 || held == 5 || held == 6 || held == 7) t = Vec3(0.0);
          for (int a = 0; a < 3; ++a)
            if (face[a] && !(held >> a & 1) && (f[a] < 0.5 ? t[a] < 0 : t[a] > 0)) legal = false;
          if (legal) maximum = std::max(maximum, norm(t));
        }
      }
  return maximum / grid.domain_length();
}

struct Grid {
  const char* name;
  double level;
  int resolution;
  bool anisotropic = false;
};
void PrintTo(const Grid& g, std::ostream* out) { *out << g.name << " " << g.resolution; }

class SampledIsosurface : public testing::TestWithParam<Grid> {
 protected:
  static std::shared_ptr<const field::ScalarGrid> make(const Grid& p) {
    const double h = 4.0 / (p.resolution - 1);
    const Vec3 edge = p.anisotropic ? Vec3(h, 0.7 * h, 2.1 * h) : Vec3(h);
    const field::Index3 size = p.anisotropic ? field::Index3{p.resolution, static_cast<int>(4 / (0.7 * h)), static_cast<int>(4 / (2.1 * h))}
                                             : field::Index3{p.resolution, p.resolution, p.resolution};
    Mat3 j(0.0);
    for (int a = 0; a < 3; ++a) j[a][a] = edge[a];
    field::Cursor cursor;
    return sample_scalar_grid(field::Mapping::from_linear(j, Vec3(-2.0)), size,
                              [exact = analytic_field(p.name), &cursor](const Vec3& x) { return exact->sample(x, cursor).value; });
  }
  void count(const Vec3& probe, const LinkState& state) {
    const double left = descent_left(*grid, state.proxy, probe);
    const SurfaceCheck j = check_on_surface(*grid, GetParam().level, probe, state.proxy);
    const bool holds = state.status == LinkStatus::ok || state.status == LinkStatus::boundary;
    tally.add(state, !holds || !(left <= kTangential) || !(j.off_level <= kOffSampled), j.off_level,
              state.status == LinkStatus::ok ? left : 0);
  }
  const std::shared_ptr<const field::ScalarGrid> grid = make(GetParam());
  const ConstraintPtr constraint = isosurface(grid, GetParam().level);
  SurfaceTally tally;
};

TEST_P(SampledIsosurface, ReachesTheClosestPointFromAnyStart) {
  Random random(11);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 probe = random.box(1.6);
    Rig rig(constraint);
    rig.arrive(probe);
    count(probe, rig.state);
  }
  EXPECT_LE(tally.bad, tally.runs / 1000) << tally.text();
}

TEST_P(SampledIsosurface, FollowsAWalkingHand) {
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

TEST_P(SampledIsosurface, FollowsJumps) {
  Rig rig(constraint);
  Random random(13);
  rig.tick({0.9, 0.3, 0.4});
  int later = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 probe = random.box(1.4);
    later += rig.arrive(probe);
    count(probe, rig.state);
  }
  EXPECT_LE(later, tally.runs / 30);
  EXPECT_LE(tally.bad, tally.runs / 1000 + 1) << tally.text();
}

INSTANTIATE_TEST_SUITE_P(Grids, SampledIsosurface,
                         testing::Values(Grid{"torus", 0.4, 32}, Grid{"torus", 0.4, 64}, Grid{"sphere", 1, 32}, Grid{"sphere", 1, 64},
                                         Grid{"gaussian", 0.5, 48}, Grid{"sphere", 1, 48, true}),
                         [](const auto& test) {
                           return std::string(test.param.name) + std::to_string(test.param.resolution) +
                                  (test.param.anisotropic ? "boxes" : "");
                         });

}  // namespace catena::haptics::tests::isosurface_test
