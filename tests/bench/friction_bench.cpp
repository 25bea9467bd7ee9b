// SPDX-License-Identifier: MIT
/// The preset anisotropic_friction (three links) on 256^3 grids, and each of its links alone: quantiles of the tick and of the
/// evaluations per link as counters, compared with a lower bound: one sample of value and gradient on the same walk.
#include "haptics/constraints/presets/mode_presets.h"
#include "tests/bench/chain_bench.h"

namespace friction_bench {

using namespace catena;
using namespace catena::bench;

struct Data {
  const char* surface;
  double level;
  const char* field;
  Vec3 centre;    ///< centre of the hand's path
  double radius;  ///< radius of the hand's path
};
const Data kSphere{"sphere", 1, "circle", {0.75, 0, 0.6}, 0.3}, kTorus{"torus", 0.4, "hill", {1, 0, 0.4}, 0.3};

/// The preset's links, or one of them.
HapticProgram program_of(const Data& data, int only = -1) {
  const BuildContext context = make_context_256(2);
  char text[200];
  std::snprintf(text, sizeof text, R"({"name": "skin", "type": "anisotropic_friction", "surface": "%s", "level": %g, "field": "%s"})",
                data.surface, data.level, data.field);
  HapticProgram program;
  const auto nodes = expand_link(*json::parse(text, "bench"));
  CATENA_ASSERT(static_cast<bool>(nodes));
  for (std::size_t i = 0; i < nodes->size(); ++i) {
    if (only >= 0 && i != static_cast<std::size_t>(only) && i != 0) continue;
    program.links.push_back(make_link((*nodes)[i], context));
  }
  return program;
}

/// A hand with tremor at about 0.2 units/s, in and out of the surface.
std::vector<ProbeSample> path_of(const Data& data) { return probe_path(data.centre, data.radius, 0.6, 0.15); }

auto run(const Data& data, int only = -1) {
  return [&data, only](benchmark::State& state) { run_chain(state, program_of(data, only), path_of(data)); };
}

[[maybe_unused]] const bool registered = register_benchmarks({{"AnisotropicFrictionSphereCircle256", run(kSphere)},
                                                              {"AnisotropicFrictionTorusHill256", run(kTorus)},
                                                              {"IsosurfaceAloneTorus256", run(kTorus, 0)},
                                                              {"IsosurfaceAndDirectionTorusHill256", run(kTorus, 1)},
                                                              {"IsosurfaceAndModulatedTorusHill256", run(kTorus, 2)}});

/// The lower bound: the cost of one sample of value and gradient on the same walk.
void FetchOnTheWalkTorus256(benchmark::State& state) {
  const field::ScalarField& grid = *sampled_grid_256(kTorus.surface).scalar;
  const std::vector<ProbeSample> path = path_of(kTorus);
  field::Cursor cursor;
  for (auto _ : state)
    for (const ProbeSample& p : path) benchmark::DoNotOptimize(grid.sample(p.position, cursor));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * path.size()));
  state.counters["ns_per_fetch"] = benchmark::Counter(static_cast<double>(path.size()) * 1e-9,
                                                      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(FetchOnTheWalkTorus256);

}  // namespace friction_bench
