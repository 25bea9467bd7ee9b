/// The anisotropic friction mode (three links) on 256^3 grids, and each of its links alone: quantiles of a tick and of the
/// evaluations a link as counters, beside the hand-written floor, one value + gradient fetch on the same walk.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "engine/field/analytic.h"
#include "engine/field/grid.h"
#include "haptics/constraints/modes.h"
#include "haptics/servo/replay.h"

namespace {

using namespace catena;
using namespace catena::haptics;

struct Data {
  const char* surface;
  double level;
  const char* field;
  Vec3 centre;    ///< of the hand's path
  double radius;  ///< of it
};
constexpr double kBox = 2;
const Data kSphere{"sphere", 1, "circle", {0.75, 0, 0.6}, 0.3}, kTorus{"torus", 0.4, "hill", {1, 0, 0.4}, 0.3};

const field::AnyField& grid_of(const std::string& name) {
  static std::vector<std::pair<std::string, field::AnyField>> made;
  for (const auto& [other, grid] : made)
    if (other == name) return grid;
  const auto formula = field::make_analytic(name);
  field::AnyField grid;
  if (formula->scalar)
    grid.scalar = field::sample_on_grid(*formula->scalar, 256, -kBox, kBox);
  else
    grid.vector = field::sample_on_grid(*formula->vector, 256, -kBox, kBox);
  made.emplace_back(name, grid);
  return made.back().second;
}

/// The mode's links, or one of them.
Program program_of(const Data& data, int only = -1) {
  BuildContext context;
  context.field = [](const json::Node&, const std::string& field) -> Result<field::AnyField> { return grid_of(field); };
  char text[200];
  std::snprintf(text, sizeof text, R"({"name": "skin", "type": "anisotropic_friction", "surface": "%s", "level": %g, "field": "%s"})",
                data.surface, data.level, data.field);
  Program program;
  const auto nodes = expand_link(*json::parse(text, "bench"));
  CATENA_ASSERT(static_cast<bool>(nodes));
  for (std::size_t i = 0; i < nodes->size(); ++i) {
    if (only >= 0 && i != static_cast<std::size_t>(only) && i != 0) continue;
    auto built = build_constraint((*nodes)[i], context);
    CATENA_ASSERT(static_cast<bool>(built));
    Link link;
    link.name = (*nodes)[i].find("name")->string;
    link.constraint = *built;
    program.links.push_back(link);
  }
  return program;
}

/// A hand at about 0.2 units/s with tremor, in and out of the surface.
std::vector<ProbeSample> hand_path(const Data& data) {
  std::vector<ProbeSample> path;
  for (int k = 0; k < 20000; ++k) {
    const double t = 1e-3 * k, a = 0.6 * t, r = data.radius * (0.6 + 0.4 * std::sin(0.37 * a));
    path.push_back({t,
                    data.centre + Vec3(r * std::cos(a) + 0.002 * std::sin(60 * t), r * std::sin(1.1 * a),
                                       0.15 * std::sin(0.7 * a) + 0.002 * std::cos(57 * t)),
                    0});
  }
  return path;
}

void run(benchmark::State& state, const Data& data, int only = -1) {
  const Program program = program_of(data, only);
  const std::vector<ProbeSample> path = hand_path(data);
  ReplayStats last;
  for (auto _ : state) last = replay(program, path, [](const exchange::HapticState&) { return true; });
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * path.size()));
  state.counters["p50_ns"] = last.tick_ns_p50;
  state.counters["p99_ns"] = last.tick_ns_p99;
  state.counters["p999_ns"] = last.tick_ns_p999;
  state.counters["max_ns"] = last.tick_ns_max;

  // evaluations a link
  std::vector<std::vector<int>> evaluations(program.links.size());
  replay(program, path, [&](const exchange::HapticState& tick) {
    for (std::size_t i = 0; i < evaluations.size(); ++i) evaluations[i].push_back(tick.links[i].evaluations);
    return true;
  });
  for (std::size_t i = 0; i < evaluations.size(); ++i) {
    std::vector<int>& e = evaluations[i];
    std::sort(e.begin(), e.end());
    const std::string name = program.links[i].name.substr(5);
    state.counters[name + "_e50"] = e[e.size() / 2];
    state.counters[name + "_e99"] = e[e.size() * 99 / 100];
    state.counters[name + "_emax"] = e.back();
  }
}

void AnisotropicFrictionSphereCircle256(benchmark::State& state) { run(state, kSphere); }
void AnisotropicFrictionTorusHill256(benchmark::State& state) { run(state, kTorus); }
void IsosurfaceAloneTorus256(benchmark::State& state) { run(state, kTorus, 0); }
void IsosurfaceAndDirectionTorusHill256(benchmark::State& state) { run(state, kTorus, 1); }
void IsosurfaceAndModulatedTorusHill256(benchmark::State& state) { run(state, kTorus, 2); }
BENCHMARK(AnisotropicFrictionSphereCircle256)->Unit(benchmark::kMillisecond);
BENCHMARK(AnisotropicFrictionTorusHill256)->Unit(benchmark::kMillisecond);
BENCHMARK(IsosurfaceAloneTorus256)->Unit(benchmark::kMillisecond);
BENCHMARK(IsosurfaceAndDirectionTorusHill256)->Unit(benchmark::kMillisecond);
BENCHMARK(IsosurfaceAndModulatedTorusHill256)->Unit(benchmark::kMillisecond);

/// The floor: what one fetch of value and gradient costs on the same walk.
void FetchOnTheWalkTorus256(benchmark::State& state) {
  const field::ScalarField& grid = *grid_of(kTorus.surface).scalar;
  const std::vector<ProbeSample> path = hand_path(kTorus);
  field::Cursor cursor;
  for (auto _ : state)
    for (const ProbeSample& p : path) benchmark::DoNotOptimize(grid.sample(p.position, cursor));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * path.size()));
  state.counters["ns_per_fetch"] = benchmark::Counter(static_cast<double>(path.size()) * 1e-9,
                                                      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(FetchOnTheWalkTorus256);

/// A tick's own cost: clock, empty chain.
void TickOfAnEmptyChain(benchmark::State& state) {
  const std::vector<ProbeSample> path = hand_path(kTorus);
  ReplayStats last;
  for (auto _ : state) last = replay(Program{}, path, [](const exchange::HapticState&) { return true; });
  state.counters["p50_ns"] = last.tick_ns_p50;
}
BENCHMARK(TickOfAnEmptyChain)->Unit(benchmark::kMillisecond);

}  // namespace
