// SPDX-License-Identifier: MIT
// Folded and steep formulas: the marschner-lobb ripples (radius of curvature down to L / 2000) and the far flank of a gaussian.
// Checked with formulas of this file, not with the field's samples. A valid proxy is OK, off the level by at most 1e-11 L, and has a
// tangential residual of at most 1e-6 L, within 20 still ticks, after which it rests exactly.
#include <numbers>

#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::isosurface_folded_test {

constexpr double kLength = 4, kPi = std::numbers::pi;

struct Formula {
  const char* name;
  double (*value)(const Vec3&);
  Vec3 (*gradient)(const Vec3&);
};

double ripple_phase(double r) { return 12 * kPi * std::cos(kPi * r / 2); }
double ripples(const Vec3& p) { return 0.4 * (1 - std::sin(kPi * p.z / 2)) + 0.1 * (1 + std::cos(ripple_phase(std::hypot(p.x, p.y)))); }
Vec3 ripples_gradient(const Vec3& p) {
  const double r = std::hypot(p.x, p.y);
  const double by_r = 0.1 * std::sin(ripple_phase(r)) * 6 * kPi * kPi * std::sin(kPi * r / 2);
  return {r > 0 ? by_r * p.x / r : 0, r > 0 ? by_r * p.y / r : 0, -0.2 * kPi * std::cos(kPi * p.z / 2)};
}
double bell(const Vec3& p) { return std::exp(-2 * (p.x * p.x + p.y * p.y + p.z * p.z)); }
Vec3 bell_gradient(const Vec3& p) { return p * (-4 * bell(p)); }

const Formula kRipples{"marschner-lobb", ripples, ripples_gradient}, kBell{"gaussian", bell, bell_gradient};

class Judge {
 public:
  Judge(const Formula& formula, double level) : rig(isosurface(analytic_field(formula.name), level)), formula_(formula), level_(level) {}

  /// One new probe and the still ticks after it.
  void run(const Vec3& probe) {
    rig.tick(probe);
    bool good = is_good(rig.state, probe);
    late += !good;
    ++runs;
    for (int i = 0; i < 20 && !good; ++i) {
      EXPECT_EQ(rig.state.status, LinkStatus::budget) << "given up at " << probe.x << " " << probe.y << " " << probe.z;
      EXPECT_LE(rig.state.evaluations, kMaxEvaluations);
      rig.tick(probe);
      good = is_good(rig.state, probe);
    }
    bad += !good;
    if (!good) return;
    const Vec3 proxy = rig.state.proxy;
    rig.tick(probe);
    restless += !bitwise_equal(rig.state.proxy, proxy) || rig.state.evaluations != 0;
    no_minimum += !is_minimum(proxy, probe);
  }
  /// All proxies were good; at most `max_late` of them not in the first tick.
  void expect_good(int max_late, bool minima = true) const {
    EXPECT_EQ(bad, 0);
    EXPECT_EQ(restless, 0) << "moved at rest";
    EXPECT_EQ(minima ? no_minimum : 0, 0);
    EXPECT_LE(late, max_late);
  }

  Rig rig;
  int runs = 0, late = 0, bad = 0, restless = 0, no_minimum = 0;

 private:
  bool is_good(const LinkState& state, const Vec3& probe) const {
    const Vec3 g = formula_.gradient(state.proxy), e = probe - state.proxy, n = direction(g);
    const double off = std::fabs(formula_.value(state.proxy) - level_) / norm(g) / kLength;
    return state.status == LinkStatus::ok && off <= 1e-11 && norm(e - n * dot(n, e)) / kLength <= 1e-6;
  }

  /// True if no neighbour on the surface, 2e-6 L away in eight directions, is nearer to the probe.
  bool is_minimum(const Vec3& proxy, const Vec3& probe) const {
    const Vec3 n = direction(formula_.gradient(proxy));
    const Vec3 a = direction(cross(n, std::fabs(n.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0))), b = cross(n, a);
    for (int k = 0; k < 8; ++k) {
      Vec3 q = proxy + (a * std::cos(kPi * k / 4) + b * std::sin(kPi * k / 4)) * (2e-6 * kLength);
      for (int i = 0; i < 4; ++i) {
        const Vec3 g = formula_.gradient(q);
        q = q - g * ((formula_.value(q) - level_) / dot(g, g));
      }
      if (norm(probe - q) < norm(probe - proxy) - 1e-12 * kLength) return false;
    }
    return true;
  }

  Formula formula_;
  double level_;
};

TEST(FoldedIsosurface, RipplesFromColdStarts) {
  Judge judge(kRipples, 0.5);
  Random random(21);
  for (int i = 0; i < 2000; ++i) {
    judge.rig = Rig(judge.rig.constraint);
    judge.run(random.box(1));
  }
  judge.expect_good(judge.runs / 100);
}

TEST(FoldedIsosurface, RipplesAfterJumps) {
  for (const double level : {0.3, 0.5}) {
    Judge judge(kRipples, level);
    Random random(22);
    Vec3 probe(0.2, -0.1, 0.3);
    for (int i = 0; i < 2000; ++i) {
      Vec3 next;
      do next = probe + random.unit() * random.uniform(0.02, 1.5);
      while (max_abs(next) > 1);
      probe = next;
      judge.run(probe);
    }
    judge.expect_good(judge.runs / 20);
  }
}

TEST(FoldedIsosurface, RipplesAfterJumpsFromSideToSide) {
  Judge judge(kRipples, 0.5);
  Random random(26);
  for (int i = 0; i < 2000; ++i) judge.run(random.box(1.5));
  judge.expect_good(judge.runs * 15 / 100);  // a hundred ridges on the path
}

TEST(FoldedIsosurface, AHandFollowsTheRipples) {
  Judge judge(kRipples, 0.5);
  Wanderer hand{Random(23), 5e-4, 5e-5, 0.8, Vec3(0.4, 0.1, 0.3)};
  for (int i = 0; i < 4000; ++i) judge.run(hand.step());
  judge.expect_good(judge.runs / 200, false);
}

TEST(FoldedIsosurface, AStartAboveTheRipplesReachesTheSurface) {
  Judge judge(kRipples, 0.5);
  const Vec3 probe(-0.7, 0.9, 0.8);
  judge.run(probe);
  judge.expect_good(0, false);
  EXPECT_LE(norm(probe - judge.rig.state.proxy), 0.66);  // the level is 0.640 away
}

TEST(FoldedIsosurface, TheFarFlankOfAGaussianAfterJumps) {
  for (const double level : {1e-5, 1e-3, 0.01}) {
    Judge judge(kBell, level);
    Random random(24);
    double worst = 0;
    const double radius = std::sqrt(-0.5 * std::log(level));
    for (int i = 0; i < 3000; ++i) {
      const Vec3 probe = random.box(2);
      judge.run(probe);
      // near the centre all points of the sphere are equally close, up to the allowed residual
      worst = std::max(worst, norm(judge.rig.state.proxy - direction(probe) * radius) * std::min(norm(probe) / radius, 1.0));
    }
    judge.expect_good(0, false);
    EXPECT_LE(worst, 1e-6 * kLength) << level;
  }
}

TEST(FoldedIsosurface, ADegenerateSurfaceIsReportedAsCriticalOrAbsent) {
  // level 0 is the circle |x| = 1 in z = 0, not a surface
  int given_up = 0;
  Random random(25);
  for (int i = 0; i < 50; ++i) {
    Rig rig(isosurface(analytic_field("torus"), 0));
    for (int k = 0; k < 5; ++k) {
      const Vec3 probe = random.box(1.5);
      for (int still = 0; still < 20; ++still) rig.tick(probe);
      ASSERT_TRUE(is_finite(rig.state.proxy));
      ASSERT_TRUE(rig.state.status == LinkStatus::critical || rig.state.status == LinkStatus::no_surface)
          << i << " status " << static_cast<int>(rig.state.status);
      if (rig.state.status == LinkStatus::no_surface) continue;
      ++given_up;
      EXPECT_NEAR(std::hypot(rig.state.proxy.x, rig.state.proxy.y), 1, 1e-8);
      EXPECT_EQ(rig.state.evaluations, 0);
    }
  }
  EXPECT_GT(given_up, 0);
}

}  // namespace catena::haptics::tests::isosurface_folded_test
