/// The tick of a streamline and an isosurface on 256^3 grids: mean time, and its quantiles as counters (nanoseconds).
#include <benchmark/benchmark.h>

#include <cmath>

#include "engine/field/analytic.h"
#include "engine/field/grid.h"
#include "haptics/constraints/registry.h"
#include "haptics/servo/replay.h"

namespace {

using namespace catena;
using namespace catena::haptics;

struct Fields {
  field::ScalarFieldPtr scalar = field::sample_on_grid(*(*field::make_analytic("torus")).scalar, 256, -2, 2);
  field::VectorFieldPtr vector = field::sample_on_grid(*(*field::make_analytic("hill")).vector, 256, -1.2, 1.2);
};

const Fields& fields() {
  static const Fields instance;
  return instance;
}

Link make_link(const char* name, const char* text) {
  BuildContext context;
  context.field = [](const json::Node&, const std::string& field) -> Result<field::AnyField> {
    return field == "v" ? field::AnyField{nullptr, fields().vector} : field::AnyField{fields().scalar, nullptr};
  };
  context.curve = [](const json::Node&, const std::string&, const flow::Flow& flow, const Vec3& seed) { return flow::trace(flow, seed); };
  const auto node = json::parse(text, "bench");
  auto built = build_constraint(*node, context);
  CATENA_ASSERT(static_cast<bool>(built));
  Link link;
  link.name = name;
  link.constraint = *built;
  return link;
}

// a hand at 0.2 units/s with tremor, near the curve and the surface
std::vector<ProbeSample> hand_path() {
  std::vector<ProbeSample> path;
  for (int k = 0; k < 20000; ++k) {
    const double t = 1e-3 * k, a = 0.4 * t;
    path.push_back(
        {t,
         {0.6 + 0.2 * std::cos(a) + 0.002 * std::sin(60 * t), 0.2 * std::sin(a), 0.3 * std::sin(0.7 * a) + 0.002 * std::cos(57 * t)},
         0});
  }
  return path;
}

void run_chain(benchmark::State& state, const Program& program) {
  const std::vector<ProbeSample> path = hand_path();
  ReplayStats last;
  for (auto _ : state) last = replay(program, path, [](const exchange::HapticState&) { return true; });
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * path.size()));
  state.counters["p50_ns"] = last.tick_ns_p50;
  state.counters["p99_ns"] = last.tick_ns_p99;
  state.counters["p999_ns"] = last.tick_ns_p999;
  state.counters["max_ns"] = last.tick_ns_max;
  state.counters["evaluations_max"] = static_cast<double>(last.evaluations_max);
}

void TickEmpty(benchmark::State& state) { run_chain(state, Program{}); }
BENCHMARK(TickEmpty)->Unit(benchmark::kMillisecond);

void TickSelectedStreamlineAndIsosurface256(benchmark::State& state) {
  Program program;
  program.links = {make_link("curve", R"({"name": "curve", "type": "streamline", "field": "v", "seed": [0.5, 0, 0]})"),
                   make_link("surface", R"({"name": "surface", "type": "isosurface", "field": "s", "level": 0.5})")};
  run_chain(state, program);
}
BENCHMARK(TickSelectedStreamlineAndIsosurface256)->Unit(benchmark::kMillisecond);

void TickOnlineStreamlineAndIsosurface256(benchmark::State& state) {
  Program program;
  program.links = {make_link("curve", R"({"name": "curve", "type": "streamline", "field": "v", "seed": [0.5, 0, 0], "follow": "online"})"),
                   make_link("surface", R"({"name": "surface", "type": "isosurface", "field": "s", "level": 0.5})")};
  run_chain(state, program);
}
BENCHMARK(TickOnlineStreamlineAndIsosurface256)->Unit(benchmark::kMillisecond);

}  // namespace
