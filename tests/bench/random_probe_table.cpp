// SPDX-License-Identifier: MIT
/// Tick times of isosurface links with random jumps of the probe (as after a device's return or a change of mode).
///   random_probe_table [TICKS [NODES]]       default 1000000 256
/// In each tick the probe is at a random position in a box of 1.2 times the domain, in five identical replays. Times in us are the minimum
/// of each tick over the replays, to exclude other load; quantiles in loads (pointer_chase.h) are the maximum of the five. Then probes
/// jump ten times and rest: number of ticks until the link rests (any status but BUDGET). One line per case: field, free side, p50 p99
/// p99.9 max in us, maximum evaluations, maximum work, fraction at rest within 20 ticks, 99.9 % quantile of the ticks to rest.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/json.h"
#include "engine/base/numbers.h"
#include "engine/field/grid/grid.h"
#include "haptics/chain/begin_link.h"
#include "haptics/constraints/registry.h"
#include "tests/bench/pointer_chase.h"

namespace {

using namespace catena;
using namespace catena::haptics;

constexpr int kReplays = 5, kThrows = 20000, kHeld = 60;

struct Random {
  std::uint64_t state;
  double in(double lo, double hi) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return lo + (hi - lo) * (static_cast<double>(state >> 11) * 0x1p-53);
  }
  Vec3 box(double half) { return {in(-half, half), in(-half, half), in(-half, half)}; }
};

/// A pseudo-random number in -1..1 per voxel.
double noise(int x, int y, int z) {
  std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ull ^ static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4full ^
                    static_cast<std::uint64_t>(z) * 0x165667b19e3779f9ull;
  h = (h ^ h >> 29) * 0xbf58476d1ce4e5b9ull;
  return static_cast<double>((h ^ h >> 32) >> 11) * 0x1p-52 - 1;
}

/// Noise on a lattice of `step` voxels, interpolated by a cubic blend.
double smooth_noise(double x, double y, double z, double step) {
  const double p[3] = {x / step, y / step, z / step};
  int base[3];
  double f[3];
  for (int a = 0; a < 3; ++a) {
    base[a] = static_cast<int>(std::floor(p[a]));
    f[a] = p[a] - base[a];
    f[a] = f[a] * f[a] * (3 - 2 * f[a]);
  }
  double sum = 0;
  for (int c = 0; c < 8; ++c)
    sum += noise(base[0] + (c & 1), base[1] + (c >> 1 & 1), base[2] + (c >> 2)) * ((c & 1) ? f[0] : 1 - f[0]) *
           ((c >> 1 & 1) ? f[1] : 1 - f[1]) * ((c >> 2) ? f[2] : 1 - f[2]);
  return sum;
}

struct Case {
  const char* name;
  double level;
  std::shared_ptr<const field::ScalarGrid> grid;
};

template <class F>
std::shared_ptr<const field::ScalarGrid> grid_of(int n, const F& f, bool masked = false) {
  std::vector<float> values;
  std::vector<std::uint8_t> valid;
  values.reserve(static_cast<std::size_t>(n) * n * n);
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const Vec3 p = Vec3(-1.0) + (2.0 / (n - 1)) * Vec3(x, y, z);
        values.push_back(static_cast<float>(f(p, x, y, z)));
        if (masked) valid.push_back(norm(p) < 0.85 && smooth_noise(x, y, z, 12) > -0.4);
      }
  return field::make_scalar_grid("f", field::Mapping::from_linear(Mat3(2.0 / (n - 1)), Vec3(-1.0)), {n, n, n}, values, valid);
}

std::shared_ptr<const Constraint> link_on(const Case& c, const std::string& free) {
  BuildContext context;
  context.field = [&](const json::Node&, const std::string&) -> Result<field::AnyField> { return field::AnyField{c.grid, nullptr}; };
  const auto node =
      json::parse(fmt::format(R"({{"name": "a", "type": "isosurface", "field": "f", "level": {}, "free": "{}"}})", c.level, free), "");
  return build_constraint(*node, context).value();
}

struct Link {
  std::shared_ptr<const Constraint> constraint;
  LinkState state;
  LinkScratch scratch;
  void tick(const Vec3& probe) {
    state.begin_tick();
    if (!state.started) {
      state.switched_on = state.started = true;
      constraint->start(probe, state, scratch);
    }
    constraint->advance(probe, state, scratch);
  }
};

void measure(const Case& c, const std::string& free, std::size_t ticks, double load_ns) {
  const auto constraint = link_on(c, free);
  std::vector<float> fastest(ticks, 1e30f), times(ticks);
  double worst_999 = 0, worst = 0;
  int evaluations = 0, work = 0;
  for (int replay = 0; replay < kReplays; ++replay) {
    Link link{constraint, {}, {}};
    Random random{17};
    for (std::size_t i = 0; i < ticks; ++i) {
      const Vec3 probe = random.box(1.2);
      const std::int64_t before = now_ns();
      link.tick(probe);
      times[i] = 1e-3f * static_cast<float>(now_ns() - before);
      fastest[i] = std::min(fastest[i], times[i]);
      evaluations = std::max(evaluations, link.state.evaluations);
      work = std::max(work, link.state.work());
    }
    worst_999 = std::max<double>(worst_999, quantile(times, 0.999));
    worst = std::max<double>(worst, quantile(times, 1));
  }

  // jumps, then rests
  Random random{5};
  std::vector<float> rest;
  int within = 0;
  for (int t = 0; t < kThrows; ++t) {
    Link link{constraint, {}, {}};
    Vec3 probe(0.0);
    for (int k = 0; k < 10; ++k) {
      probe = random.box(1.2);
      link.tick(probe);
    }
    int held = 0;
    while (held < kHeld && link.state.status == LinkStatus::budget) {
      link.tick(probe);
      ++held;
    }
    within += held <= 20;
    rest.push_back(static_cast<float>(held));
  }
  fmt::print(
      "{:<18} {:<6} p50 {:6.2f}  p99 {:7.2f}  p99.9 {:7.2f}  max {:7.2f} us; p99.9 {:.0f} T, max {:.0f} T; evaluations {:3}  work {:4}  at "
      "rest within 20: {:.4f}  99.9 "
      "%: {:.0f} "
      "ticks\n",
      c.name, free, quantile(fastest, 0.5), quantile(fastest, 0.99), quantile(fastest, 0.999), quantile(fastest, 1),
      1e3 * worst_999 / load_ns, 1e3 * worst / load_ns, evaluations, work, static_cast<double>(within) / kThrows, quantile(rest, 0.999));
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) {
  const std::size_t ticks = count > 1 ? std::strtoull(arguments[1], nullptr, 10) : 1000000;
  const int n = count > 2 ? std::atoi(arguments[2]) : 256;
  const auto ball = [](const Vec3& p, int, int, int) { return norm(p); };
  const auto waves = [](const Vec3&, int x, int y, int z) {
    return smooth_noise(x, y, z, 24) + 0.5 * smooth_noise(x + 1000, y, z, 11) + 0.25 * smooth_noise(x, y + 1000, z, 5);
  };
  const auto noisy = [](const Vec3& p, int x, int y, int z) { return norm(p) + 0.05 * noise(x, y, z); };
  const double load_ns = bench::load_latency_ns();
  fmt::print("T {:.1f} ns\n", load_ns);
  for (const Case& c :
       {Case{"ball", 0.6, grid_of(n, ball)}, Case{"waves", 0.1, grid_of(n, waves)}, Case{"noisy ball", 0.6, grid_of(n, noisy)},
        Case{"waves, masked", 0.1, grid_of(n, waves, true)}, Case{"noisy, masked", 0.6, grid_of(n, noisy, true)}})
    for (const char* free : {"none", "above", "below"}) measure(c, free, ticks, load_ns);
}
