// SPDX-License-Identifier: MIT
// Isosurface links on formulas and sampled grids: closest points, convergence and evaluations. Figures are printed on failure.
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests {
namespace isosurface_test {

constexpr double kOffAnalytic = 1e-11, kOffSampled = 1e-9, kTangential = 1e-6;  // fractions of L

struct Tally {
  int runs = 0, bad = 0;
  double worst_off = 0, worst_tangential = 0;
  Quantiles evaluations;
  std::string text() {
    char line[200];
    std::snprintf(line, sizeof line, "%d of %d bad; off level %.2g L, tangential %.2g L; evaluations p50 %d p99 %d max %d", bad, runs,
                  worst_off, worst_tangential, evaluations.at_quantile(0.5), evaluations.at_quantile(0.99), evaluations.at_quantile(1));
    return line;
  }
};

struct Formula {
  const char* name;
  double level;
};
void PrintTo(const Formula& f, std::ostream* out) { *out << f.name << " at " << f.level; }

class AnalyticIsosurface : public testing::TestWithParam<Formula> {};

TEST_P(AnalyticIsosurface, ReachesTheClosestPointFromAnyStart) {
  const auto f = analytic_field(GetParam().name);
  const auto constraint = isosurface(f, GetParam().level);
  Random random(7);
  Tally tally;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 probe = random.box(2);
    Rig rig(constraint);
    rig.tick(probe);
    const SurfaceCheck j = check_on_surface(*f, GetParam().level, probe, rig.state.proxy);
    ++tally.runs;
    tally.evaluations.add(rig.state.evaluations);
    tally.worst_off = std::max(tally.worst_off, j.off_level);
    tally.worst_tangential = std::max(tally.worst_tangential, j.tangential);
    tally.bad += rig.state.status != LinkStatus::ok || !(j.off_level <= kOffAnalytic) || !(j.tangential <= kTangential);
  }
  EXPECT_EQ(tally.bad, 0) << tally.text();
  RecordProperty("figures", tally.text());
}

TEST_P(AnalyticIsosurface, FollowsJumpsWithinTheTick) {
  const auto f = analytic_field(GetParam().name);
  const auto constraint = isosurface(f, GetParam().level);
  Random random(8);
  Tally tally;
  Rig rig(constraint);
  rig.tick(random.box(1));
  for (int i = 0; i < 5000; ++i) {
    const Vec3 probe = random.box(1.5);
    rig.tick(probe);
    const SurfaceCheck j = check_on_surface(*f, GetParam().level, probe, rig.state.proxy);
    ++tally.runs;
    tally.evaluations.add(rig.state.evaluations);
    tally.worst_off = std::max(tally.worst_off, j.off_level);
    tally.worst_tangential = std::max(tally.worst_tangential, j.tangential);
    tally.bad += rig.state.status != LinkStatus::ok || !(j.off_level <= kOffAnalytic) || !(j.tangential <= kTangential);
  }
  EXPECT_EQ(tally.bad, 0) << tally.text();
  EXPECT_LE(tally.evaluations.at_quantile(0.99), 32) << tally.text();
  RecordProperty("figures", tally.text());
}

TEST_P(AnalyticIsosurface, AHandsMotionNeedsFewEvaluations) {
  const auto f = analytic_field(GetParam().name);
  Rig rig(isosurface(f, GetParam().level));
  Random random(9);
  Vec3 probe(0.9, 0.3, 0.4), velocity = random.unit() * 2e-3;
  Tally tally;
  for (int i = 0; i < 4000; ++i) {
    velocity = direction(velocity + random.unit() * 2e-4) * 2e-3;
    if (norm(probe + velocity) > 1.7) velocity = velocity * -1.0;
    probe = probe + velocity;
    rig.tick(probe);
    if (i == 0) continue;
    const SurfaceCheck j = check_on_surface(*f, GetParam().level, probe, rig.state.proxy);
    ++tally.runs;
    tally.evaluations.add(rig.state.evaluations);
    tally.worst_off = std::max(tally.worst_off, j.off_level);
    tally.worst_tangential = std::max(tally.worst_tangential, j.tangential);
    tally.bad += rig.state.status != LinkStatus::ok || !(j.off_level <= kOffAnalytic) || !(j.tangential <= kTangential);
  }
  EXPECT_EQ(tally.bad, 0) << tally.text();
  EXPECT_LE(tally.evaluations.at_quantile(0.5), 3) << tally.text();
  RecordProperty("figures", tally.text());
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

TEST(Isosurface, StartsOnPlateausReachTheSurface) {
  const auto f = analytic_field("tanh");
  for (const double z : {0.1, -0.5, 1.0, -1.9, 1.99}) {
    Rig rig(isosurface(f, 0.3));
    rig.tick({0.3, 0.2, z});
    EXPECT_EQ(rig.state.status, LinkStatus::ok) << z << " after " << rig.state.evaluations;
    EXPECT_LE(check_on_surface(*f, 0.3, {0.3, 0.2, z}, rig.state.proxy).off_level, kOffAnalytic) << z;
  }
}

// ---- grids ----

/// Maximum feasible descent of |probe - p| at p over the adjoining cells, as a fraction of L. For grids with axis-aligned voxels.
double descent_left(const field::ScalarGrid& grid, const Vec3& proxy, const Vec3& probe) {
  const field::Mapping& m = grid.mapping();
  const Vec3 index = m.index_from_world(proxy);
  field::Cursor cursor;
  std::array<std::vector<int>, 3> bases;
  std::array<bool, 3> face{};
  for (int a = 0; a < 3; ++a) {
    const double nearest = std::floor(index[a] + 0.5);
    face[static_cast<std::size_t>(a)] = std::fabs(index[a] - nearest) < 1e-9;
    const int low = static_cast<int>(face[static_cast<std::size_t>(a)] ? nearest - 1 : std::floor(index[a]));
    for (const int b : {low, low + 1})
      if ((b == low || face[static_cast<std::size_t>(a)]) && b >= grid.index_box().lo[a] && b <= grid.index_box().hi[a] - 1)
        bases[static_cast<std::size_t>(a)].push_back(b);
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
            legal = legal && face[static_cast<std::size_t>(a)];
            n[a] = e[a] = 0;
          }
          n = direction(n);
          if (!legal || !(max_abs(n) > 0)) continue;
          Vec3 t = e - n * dot(n, e);
          if (held == 3 || held == 5 || held == 6 || held == 7) t = Vec3(0.0);
          for (int a = 0; a < 3; ++a)
            if (face[static_cast<std::size_t>(a)] && !(held >> a & 1) && (f[a] < 0.5 ? t[a] < 0 : t[a] > 0)) legal = false;
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
  std::shared_ptr<const field::ScalarGrid> make() const {
    const Grid& p = GetParam();
    const auto exact = analytic_field(p.name);
    const double h = 4.0 / (p.resolution - 1);
    const Vec3 edge = p.anisotropic ? Vec3(h, 0.7 * h, 2.1 * h) : Vec3(h);
    const field::Index3 size = p.anisotropic ? field::Index3{p.resolution, static_cast<int>(4 / (0.7 * h)), static_cast<int>(4 / (2.1 * h))}
                                             : field::Index3{p.resolution, p.resolution, p.resolution};
    Mat3 j(0.0);
    for (int a = 0; a < 3; ++a) j[a][a] = edge[a];
    field::Cursor cursor;
    return sample_scalar_grid(field::Mapping::from_linear(j, Vec3(-2.0)), size,
                              [&](const Vec3& x) { return exact->sample(x, cursor).value; });
  }
  /// Holds the probe still until the proxy has arrived. True if that took more than one tick.
  static bool arrive(Rig& rig, const Vec3& probe) {
    if (rig.tick(probe).status != LinkStatus::budget) return false;
    for (int k = 0; k < 3 && rig.state.status == LinkStatus::budget; ++k) rig.tick(probe);
    return true;
  }
  void count(Tally& tally, const field::ScalarGrid& grid, const Vec3& probe, const LinkState& state) const {
    ++tally.runs;
    tally.evaluations.add(state.evaluations);
    const double left = descent_left(grid, state.proxy, probe);
    const SurfaceCheck j = check_on_surface(grid, GetParam().level, probe, state.proxy);
    tally.worst_off = std::max(tally.worst_off, j.off_level);
    if (state.status == LinkStatus::ok) tally.worst_tangential = std::max(tally.worst_tangential, left);
    tally.bad +=
        (state.status != LinkStatus::ok && state.status != LinkStatus::boundary) || !(left <= kTangential) || !(j.off_level <= kOffSampled);
    EXPECT_LE(state.evaluations, kMaxEvaluations);
  }
};

TEST_P(SampledIsosurface, ReachesTheClosestPointFromAnyStart) {
  const auto grid = make();
  const auto constraint = isosurface(grid, GetParam().level);
  Random random(11);
  Tally tally;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 probe = random.box(1.6);
    Rig rig(constraint);
    arrive(rig, probe);
    count(tally, *grid, probe, rig.state);
  }
  EXPECT_LE(tally.bad, tally.runs / 1000) << tally.text();
  RecordProperty("figures", tally.text());
}

TEST_P(SampledIsosurface, FollowsAWalkingHand) {
  const auto grid = make();
  Rig rig(isosurface(grid, GetParam().level));
  Random random(12);
  const double speed = 0.3 * grid->mapping().min_voxel_edge();
  Vec3 probe(0.9, 0.3, 0.4), velocity = random.unit() * speed;
  rig.tick(probe);
  Tally tally;
  for (int i = 0; i < 5000; ++i) {
    velocity = direction(velocity + random.unit() * (0.1 * speed)) * speed;
    if (norm(probe + velocity) > 1.6) velocity = velocity * -1.0;
    probe = probe + velocity;
    rig.tick(probe);
    count(tally, *grid, probe, rig.state);
  }
  EXPECT_LE(tally.bad, tally.runs / 1000) << tally.text();
  RecordProperty("figures", tally.text());
}

TEST_P(SampledIsosurface, FollowsJumps) {
  const auto grid = make();
  Rig rig(isosurface(grid, GetParam().level));
  Random random(13);
  rig.tick({0.9, 0.3, 0.4});
  Tally tally;
  int later = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 probe = random.box(1.4);
    later += arrive(rig, probe);
    count(tally, *grid, probe, rig.state);
  }
  EXPECT_LE(later, tally.runs / 30);
  EXPECT_LE(tally.bad, tally.runs / 1000 + 1) << tally.text();
  RecordProperty("figures", tally.text());
}

INSTANTIATE_TEST_SUITE_P(Grids, SampledIsosurface,
                         testing::Values(Grid{"torus", 0.4, 32}, Grid{"torus", 0.4, 64}, Grid{"sphere", 1, 32}, Grid{"sphere", 1, 64},
                                         Grid{"gaussian", 0.5, 48}, Grid{"sphere", 1, 48, true}),
                         [](const auto& test) {
                           return std::string(test.param.name) + std::to_string(test.param.resolution) +
                                  (test.param.anisotropic ? "boxes" : "");
                         });

}  // namespace isosurface_test
}  // namespace catena::haptics::tests
