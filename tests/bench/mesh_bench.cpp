// SPDX-License-Identifier: MIT
// The tick on a mesh of 100,820 triangles (a sphere of radius 1): a hand slides inside and taps, at 0.2 and 1 unit/s.
#include <benchmark/benchmark.h>

#include <cmath>

#include "engine/base/clock.h"
#include "engine/base/numbers.h"
#include "haptics/constraints/registry.h"
#include "tests/support/mesh_shapes.h"

namespace mesh_bench {

using namespace catena;
using namespace catena::haptics;

const mesh::MeshPtr& sphere() {
  static const mesh::MeshPtr made = catena::test::make_mesh_from(catena::test::sphere_soup(71));
  return made;
}

/// A path on a spiral at `speed`, at depths of 0.01 to 0.04; `tapping`: out and in ten times per second.
std::vector<Vec3> hand(double speed, bool tapping) {
  std::vector<Vec3> path;
  for (int k = 0; k < 20000; ++k) {
    const double t = 1e-3 * k, a = speed * t, b = 0.3 * a;
    const double depth = tapping ? 0.03 * std::sin(62.8 * t) : 0.025 + 0.015 * std::sin(3 * t);
    path.push_back((1 - depth) * Vec3(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)));
  }
  return path;
}

void Mesh100k(benchmark::State& state, const char* free, double speed, bool tapping) {
  BuildContext context;
  context.mesh = [](const json::Node&, const std::string&) -> Result<mesh::MeshPtr> { return sphere(); };
  const auto node = json::parse(std::string(R"({"name": "a", "type": "mesh", "mesh": "m", "free": ")") + free + "\"}", "bench");
  const auto built = build_constraint(*node, context);
  CATENA_ASSERT(static_cast<bool>(built));
  const std::vector<Vec3> path = hand(speed, tapping);
  std::vector<double> times(path.size());
  for (auto _ : state) {
    LinkState link;
    LinkScratch scratch;
    (*built)->start(path.front() * 1.2, link, scratch);
    for (std::size_t k = 0; k < path.size(); ++k) {
      const std::int64_t start = now_ns();
      (*built)->advance(path[k], link, scratch);
      times[k] = static_cast<double>(now_ns() - start);
    }
    benchmark::DoNotOptimize(link.proxy);
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * path.size()));
  for (const auto& [name, part] : {std::pair{"p50_ns", 0.5}, {"p99_ns", 0.99}, {"p999_ns", 0.999}, {"max_ns", 1.0}})
    state.counters[name] = quantile(times, part);
}

BENCHMARK_CAPTURE(Mesh100k, slide_0_2, "above", 0.2, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Mesh100k, slide_1, "above", 1.0, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Mesh100k, tap_0_2, "above", 0.2, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Mesh100k, tap_1, "above", 1.0, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Mesh100k, two_sided_1, "none", 1.0, false)->Unit(benchmark::kMillisecond);

}  // namespace mesh_bench
