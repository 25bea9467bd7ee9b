// SPDX-License-Identifier: MIT
// Acceptance tests of the projector onto an isosurface, on formulas and on grids, against closed forms in long double and the grid's
// corner values.
#include "tests/acceptance/reference_numerics.h"
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::acceptance::isosurface_acceptance_test {

using catena::LinkStatus;
using haptics::bitwise_equal;
using haptics::kMaxEvaluations;
using haptics::tests::analytic_field;
using haptics::tests::isosurface;
using haptics::tests::Quantiles;
using haptics::tests::Random;
using haptics::tests::Rig;

void record_quantiles(const std::string& who, Quantiles& spread) {
  record_results(who, {{" p50", spread.at_quantile(0.5)}, {" p99", spread.at_quantile(0.99)}, {" max", spread.at_quantile(1)}});
}

struct Slope {
  Real value;
  Real3 gradient;
};

struct Formula {
  const char* name;
  double level;
  Slope (*at)(const Real3&);
};

Slope sphere(const Real3& p) { return {length(p), unit_direction(p)}; }
Slope torus(const Real3& p) {
  const Real r = std::sqrt(p.x * p.x + p.y * p.y), s = std::sqrt((r - 1) * (r - 1) + p.z * p.z);
  return {s, {(r - 1) / s * p.x / r, (r - 1) / s * p.y / r, p.z / s}};
}
Slope gaussian(const Real3& p) {
  const Real v = std::exp(-2 * dot(p, p));
  return {v, (-4 * v) * p};
}
Slope wall(const Real3& p) {
  const Real c = std::cosh(p.z / 0.05), w = 0.05;
  return {std::tanh(p.z / w), {0, 0, 1 / (w * c * c)}};
}
Slope linear(const Real3& p) { return {p.x + p.y + p.z, {1, 1, 1}}; }

constexpr Formula kFormulas[] = {
    {"sphere", 1, sphere}, {"torus", 0.4, torus}, {"gaussian", 0.5, gaussian}, {"tanh", 0.3, wall}, {"linear", 0.5, linear}};

struct Judged {
  double off_level, tangential;
  bool minimum;
};

/// Distances in L; `minimum`: no neighbour on the surface at distance 1e-3 L is nearer to the probe.
Judged judge(const Formula& f, const Vec3& probe, const Vec3& proxy) {
  const Real3 x(probe), p(proxy);
  const Slope s = f.at(p);
  const Real3 n = unit_direction(s.gradient), e = x - p;
  Judged out{static_cast<double>(std::fabs(s.value - f.level) / length(s.gradient) / 4), static_cast<double>(length(e - dot(n, e) * n) / 4),
             true};
  const Real3 a = unit_direction(std::fabs(n.x) < 0.6L ? Real3(0, n.z, -n.y) : Real3(n.z, 0, -n.x));
  const Real3 b(n.y * a.z - n.z * a.y, n.z * a.x - n.x * a.z, n.x * a.y - n.y * a.x);
  for (int k = 0; k < 8; ++k) {
    Real3 q = p + 4e-3L * (std::cos(k * M_PIl / 4) * a + std::sin(k * M_PIl / 4) * b);
    for (int i = 0; i < 5; ++i) {
      const Slope t = f.at(q);
      q = q - ((t.value - f.level) / dot(t.gradient, t.gradient)) * t.gradient;
    }
    if (length(x - q) < length(e) - 4e-7L) out.minimum = false;
  }
  return out;
}

TEST(IsosurfaceProjection, FormulasReachTheLocalClosestPointWithinATick) {
  for (const Formula& f : kFormulas) {
    const auto constraint = isosurface(analytic_field(f.name), f.level);
    Random random(81);
    double off = 0, tangential = 0;
    int failures = 0, starts = 0, above_32 = 0, no_minimum = 0;
    Quantiles cold, jump, hand;
    const auto count = [&](Rig& rig, const Vec3& probe, Quantiles& spread) {
      rig.tick(probe);
      const Judged j = judge(f, probe, rig.state.proxy);
      ++starts;
      off = std::max(off, j.off_level);
      tangential = std::max(tangential, j.tangential);
      no_minimum += !j.minimum;
      above_32 += rig.state.evaluations > 32;
      failures += rig.state.status != LinkStatus::ok || !(j.off_level <= 1e-11) || !(j.tangential <= 1e-6);
      spread.add(rig.state.evaluations);
    };
    for (int i = 0; i < 8000; ++i) {
      Rig rig(constraint);
      count(rig, random.box(2), cold);
    }
    Rig rig(constraint);
    rig.tick({0.8, 0.3, 0.2});
    for (int i = 0; i < 8000; ++i) count(rig, random.box(2), jump);
    Vec3 probe(0.9, 0.3, 0.4), velocity(0.0);
    Rig still(constraint);
    still.tick(probe);
    for (int i = 0; i < 8000; ++i) {
      velocity = direction(velocity + 2e-4 * random.unit()) * 8e-4;
      probe = norm(probe + velocity) > 1.6 ? 0.99 * probe : probe + velocity;
      count(still, probe, hand);
    }
    const std::string who = std::string(f.name) + ": ";
    expect_at_most(who + "failures of " + std::to_string(starts), failures, 0);
    expect_at_most(who + "not a minimum", no_minimum, 0);
    expect_at_most(who + "ticks above 32 evaluations", above_32, starts / 1000);  // for jumps across a torus
    record_results(who, {{"off the level / L", off}, {"tangential residual / L", tangential}});
    record_quantiles(who + "evaluations, cold", cold);
    record_quantiles(who + "evaluations, jump", jump);
    record_quantiles(who + "evaluations, hand", hand);
    EXPECT_LE(hand.at_quantile(0.99), 8) << f.name;
  }
}

TEST(IsosurfaceProjection, TheProxyRestsWhileTheProbeRests) {
  for (const bool grid : {false, true}) {
    const auto f = grid ? haptics::tests::sampled_field("sphere", 41, 3) : analytic_field("sphere");
    for (const double d : {0.1, 0.3, 0.7, 0.999, 1.001, 1.9, 2.1, 2.5, 4.0, 7.0, 12.0, 20.0}) {
      Rig rig(isosurface(f, 1));
      rig.tick({0.3, -0.9, 0.6});
      const Vec3 probe = direction(Vec3(-1, 0.7, 0.4)) * d;
      rig.tick(probe);
      const Vec3 after = rig.state.proxy;
      for (int i = 0; i < 100; ++i) {
        rig.tick(probe);
        ASSERT_TRUE(bitwise_equal(after, rig.state.proxy)) << "d = " << d << " R, tick " << i;
      }
    }
  }
}

// Eqs. 5 and 6 as printed chatter permanently: 0.71 R per tick at d = 2.5 R.
TEST(IsosurfaceProjection, Equations5And6AsPrintedChatter) {
  const Vec3 probe(2.5, 0, 0);
  Vec3 p = direction(Vec3(1, 0.4, 0));
  double motion = 0;
  for (int tick = 0; tick < 200; ++tick) {
    const Vec3 n = direction(p), e = probe - p, before = p;
    p = p + (e - n * dot(n, e));
    for (int j = 0; j < 20; ++j) p = p - direction(p) * (norm(p) - 1);
    if (tick >= 100) motion = std::max(motion, norm(p - before));
  }
  record_result("printed form: motion a tick under a still probe / R", motion);
  EXPECT_GT(motion, 0.5);
}

/// The test's own trilinear grid: corner values and spacing.
struct Samples {
  int nodes;
  double lo, h;
  std::vector<float> values;
  double corner(int x, int y, int z) const { return values[static_cast<std::size_t>((z * nodes + y) * nodes + x)]; }

  /// Value and index-space gradient of cell (i, j, k) at the local position f.
  double cell(const int (&base)[3], const double (&f)[3], double (&gradient)[3]) const {
    double value = 0;
    gradient[0] = gradient[1] = gradient[2] = 0;
    for (int c = 0; c < 8; ++c) {
      const int bit[3] = {c & 1, c >> 1 & 1, c >> 2};
      const double v = corner(base[0] + bit[0], base[1] + bit[1], base[2] + bit[2]);
      double w[3];
      for (int a = 0; a < 3; ++a) w[a] = bit[a] ? f[a] : 1 - f[a];
      value += v * w[0] * w[1] * w[2];
      gradient[0] += (bit[0] ? v : -v) * w[1] * w[2];
      gradient[1] += (bit[1] ? v : -v) * w[0] * w[2];
      gradient[2] += (bit[2] ? v : -v) * w[0] * w[1];
    }
    return value;
  }

  /// Maximum descent of |x - p| along the surface over the adjoining cells, also along the surface within faces that contain p, and the
  /// distance from the level. In world units.
  void judge(double level, const Vec3& probe, const Vec3& proxy, double& off_level, double& descent) const {
    double index[3];
    int low[3], high[3];
    for (int a = 0; a < 3; ++a) {
      index[a] = (proxy[a] - lo) / h;
      const double node = std::nearbyint(index[a]);
      const bool on_face = std::fabs(index[a] - node) < 1e-9;
      high[a] = std::min(nodes - 2, static_cast<int>(on_face ? node : std::floor(index[a])));
      low[a] = std::max(0, on_face ? static_cast<int>(node) - 1 : high[a]);
    }
    off_level = 1e300;
    descent = 0;
    for (int x = low[0]; x <= high[0]; ++x)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int z = low[2]; z <= high[2]; ++z) {
          const int base[3] = {x, y, z};
          double f[3], g[3];
          for (int a = 0; a < 3; ++a) f[a] = index[a] - base[a];
          const double value = cell(base, f, g);
          const double slope = std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]) / h;
          off_level = std::min(off_level, std::fabs(value - level) / slope);
          for (int held = 0; held < 8; ++held) descent = std::max(descent, along(f, g, held, probe - proxy));
        }
  }
  /// |t| of the component of e along the level and the free axes, if it points into the cell.
  static double along(const double (&f)[3], const double (&g)[3], int held, const Vec3& e) {
    double gg = 0, ge = 0, t[3], square = 0;
    for (int a = 0; a < 3; ++a) {
      const bool on_face = std::fabs(f[a]) < 1e-9 || std::fabs(f[a] - 1) < 1e-9;
      if (held >> a & 1) {
        if (!on_face) return 0;
        continue;
      }
      gg += g[a] * g[a];
      ge += g[a] * e[a];
    }
    if (!(gg > 0)) return 0;
    for (int a = 0; a < 3; ++a) {
      t[a] = held >> a & 1 ? 0 : e[a] - g[a] * ge / gg;
      if (std::fabs(f[a]) < 1e-9 && t[a] < 0) return 0;
      if (std::fabs(f[a] - 1) < 1e-9 && t[a] > 0) return 0;
      square += t[a] * t[a];
    }
    return std::sqrt(square);
  }
};

void expect_on_samples(const Formula& f, int nodes) {
  Samples s{nodes, -2, 4.0 / (nodes - 1), {}};
  for (int z = 0; z < nodes; ++z)
    for (int y = 0; y < nodes; ++y)
      for (int x = 0; x < nodes; ++x)
        s.values.push_back(
            static_cast<float>(f.at(Real3(s.lo + s.h * x + 1e-12L, s.lo + s.h * y + 1e-12L, s.lo + s.h * z + 1e-12L)).value));
  const auto grid = field::make_scalar_grid("made", field::Mapping::from_linear(Mat3(s.h), Vec3(s.lo)), {nodes, nodes, nodes}, s.values);
  const auto constraint = isosurface(grid, f.level);
  Random random(82);
  double off = 0, worst = 0;
  int walks = 0, failures = 0, budget = 0, wrong = 0;
  Quantiles evaluations;
  const auto count = [&](const Rig& rig, const Vec3& probe) {
    double off_level = 0, descent = 0;
    s.judge(f.level, probe, rig.state.proxy, off_level, descent);
    ++walks;
    off = std::max(off, off_level / 4);
    evaluations.add(rig.state.evaluations);
    if (rig.state.status == LinkStatus::budget) {
      ++budget;
    } else {
      worst = std::max(worst, descent / 4);
      wrong += !(descent / 4 <= 1e-6);
    }
    failures += !(off_level / 4 <= 1e-9);
  };
  for (int i = 0; i < 3000; ++i) {
    Rig rig(constraint);
    const Vec3 probe = random.box(1.6);
    rig.tick(probe);
    count(rig, probe);
  }
  Rig jumps(constraint), hand(constraint);
  jumps.tick({0.9, 0.3, 0.4});
  for (int i = 0; i < 3000; ++i) {
    const Vec3 probe = random.box(1.6);
    // a jumping probe may need a few ticks
    jumps.tick(probe);
    for (int k = 0; k < 3 && jumps.state.status == LinkStatus::budget; ++k) jumps.tick(probe);
    count(jumps, probe);
  }
  Vec3 probe(0.9, 0.3, 0.4), velocity(0.0);
  hand.tick(probe);
  for (int i = 0; i < 6000; ++i) {
    velocity = direction(velocity + 0.05 * s.h * random.unit()) * (0.2 * s.h);
    probe = norm(probe + velocity) > 1.6 ? 0.99 * probe : probe + velocity;
    hand.tick(probe);
    count(hand, probe);
  }
  const std::string who = std::string(f.name) + " " + std::to_string(nodes) + "^3: ";
  record_results(who, {{"walks", walks}, {"off the level / L", off}, {"descent left / L", worst}, {"walks out of budget", budget}});
  record_quantiles(who + "evaluations", evaluations);
  expect_at_most(who + "walks that end above 1e-6 L", wrong, 0);
  EXPECT_EQ(failures, 0) << who;
  EXPECT_LE(budget + wrong, walks / 1000) << who;
}

TEST(IsosurfaceProjection, SampledSphereReachesTheLocalClosestPoint) {
  expect_on_samples(kFormulas[0], 32);
  expect_on_samples(kFormulas[0], 64);
}
TEST(IsosurfaceProjection, SampledTorusReachesTheLocalClosestPoint) {
  expect_on_samples(kFormulas[1], 32);
  expect_on_samples(kFormulas[1], 64);
}
TEST(IsosurfaceProjection, SampledGaussianReachesTheLocalClosestPoint) { expect_on_samples(kFormulas[2], 48); }

}  // namespace catena::acceptance::isosurface_acceptance_test
