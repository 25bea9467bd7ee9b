// SPDX-License-Identifier: MIT
/// Shared helpers of the tick's benchmarks: fields sampled on 256^3, links from JSON, a hand's path, quantiles as counters.
#pragma once
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/numbers.h"
#include "engine/field/analytic/analytic.h"
#include "engine/field/grid/grid.h"
#include "haptics/constraints/registry.h"
#include "haptics/servo/replay.h"
#include "tests/bench/pointer_chase.h"

namespace catena::bench {

using namespace catena::haptics;

/// An analytic field with 256 nodes per axis on the box -half..half, sampled once.
inline const field::AnyField& sampled_grid_256(const std::string& name, double half = 2) {
  static std::map<std::pair<std::string, double>, field::AnyField> made;
  field::AnyField& grid = made[{name, half}];
  if (grid.get() != nullptr) return grid;
  const auto formula = field::make_analytic(name);
  CATENA_ASSERT(static_cast<bool>(formula));
  if (formula->scalar) grid.scalar = field::sample_on_grid(*formula->scalar, 256, -half, half);
  if (formula->vector) grid.vector = field::sample_on_grid(*formula->vector, 256, -half, half);
  return grid;
}

/// `hill_half`: half size of the box of Hill's vortex; all other fields are on -2..2.
inline BuildContext make_context_256(double hill_half = 1.2) {
  BuildContext context;
  context.field = [=](const json::Node&, const std::string& name) -> Result<field::AnyField> {
    return sampled_grid_256(name, name == "hill" ? hill_half : 2);
  };
  context.curve = [](const json::Node&, const std::string&, const flow::Flow& flow, const Vec3& seed) { return flow::trace(flow, seed); };
  return context;
}

inline Link make_link(const json::Node& node, const BuildContext& context) {
  auto built = build_constraint(node, context);
  CATENA_ASSERT(static_cast<bool>(built));
  Link link;
  link.name = node.find("name")->string;
  link.constraint = *built;
  return link;
}

inline Link make_link(const std::string& text) { return make_link(*json::parse(text, "bench"), make_context_256()); }

inline constexpr const char* kCurve = R"({"name": "curve", "type": "streamline", "field": "hill", "seed": [0.5, 0, 0]})";
inline constexpr const char* kSurface = R"({"name": "surface", "type": "isosurface", "field": "torus", "level": 0.5})";

/// A streamline and an isosurface.
inline HapticProgram make_pair_program(const char* curve = kCurve) {
  HapticProgram program;
  program.epoch = 1;
  program.links = {make_link(curve), make_link(kSurface)};
  return program;
}

/// A hand with tremor at about 0.2 units/s around `centre`, for 20 s at 1 kHz.
inline std::vector<ProbeSample> probe_path(const Vec3& centre = Vec3(0.6, 0, 0), double radius = 0.2, double turns_rad_per_s = 0.4,
                                           double height = 0.3) {
  std::vector<ProbeSample> path;
  for (int k = 0; k < 20000; ++k) {
    const double t = 1e-3 * k, a = turns_rad_per_s * t, r = radius * (0.6 + 0.4 * std::sin(0.37 * a));
    path.push_back({t,
                    centre + Vec3(r * std::cos(a) + 0.002 * std::sin(60 * t), r * std::sin(1.1 * a),
                                  height * std::sin(0.7 * a) + 0.002 * std::cos(57 * t)),
                    0});
  }
  return path;
}

/// Ticks of the program along the path. Counters in nanoseconds and in loads (pointer_chase.h): quantiles of the tick's time, the maximum
/// of five replays, including other load; "alone_": quantiles of the minimum of each tick over the five; evaluations per link.
inline void run_chain(benchmark::State& state, const HapticProgram& program, const std::vector<ProbeSample>& path = probe_path()) {
  const double load_ns = load_latency_ns();
  state.counters["T_ns"] = load_ns;
  constexpr int kReplays = 5;
  constexpr std::pair<const char*, double> kQuantiles[] = {{"p50", 0.5}, {"p99", 0.99}, {"p999", 0.999}, {"max", 1.0}};
  std::map<std::string, double> worst;
  std::vector<double> fastest(path.size(), std::numeric_limits<double>::infinity()), times(path.size());
  for (auto _ : state)
    for (int k = 0; k < kReplays; ++k) {
      auto chain = std::make_unique<ChainState>();
      auto scratch = std::make_unique<ChainScratch>();
      HapticState out;
      for (std::size_t i = 0; i < path.size(); ++i) {
        const std::int64_t start = now_ns();
        tick(program, path[i], *chain, *scratch, out);
        times[i] = static_cast<double>(now_ns() - start);
        fastest[i] = std::min(fastest[i], times[i]);
      }
      for (const auto& [name, part] : kQuantiles) worst[name] = std::max(worst[name], quantile(times, part));
    }
  for (const auto& [name, part] : kQuantiles) worst[std::string("alone_") + name] = quantile(fastest, part);
  for (const auto& [name, ns] : worst) {
    state.counters[name + "_ns"] = ns;
    state.counters[name + "_T"] = ns / load_ns;
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * kReplays * path.size()));

  std::vector<std::vector<int>> evaluations(program.links.size());
  int over_budget = 0;
  replay(program, path, [&](const HapticState& tick) {
    for (std::size_t i = 0; i < evaluations.size(); ++i) {
      evaluations[i].push_back(tick.links[i].evaluations);
      over_budget += tick.links[i].status == LinkStatus::budget;
    }
    return true;
  });
  for (std::size_t i = 0; i < evaluations.size(); ++i)
    for (const auto& [name, part] : {std::pair{"_e50", 0.5}, {"_e99", 0.99}, {"_emax", 1.0}})
      state.counters[program.links[i].name + name] = quantile(evaluations[i], part);
  state.counters["over_budget"] = over_budget;
}

struct NamedBenchmark {
  const char* name;
  std::function<void(benchmark::State&)> run;
};

/// Registers benchmarks of one iteration.
inline bool register_benchmarks(const std::vector<NamedBenchmark>& all) {
  for (const NamedBenchmark& one : all) benchmark::RegisterBenchmark(one.name, one.run)->Unit(benchmark::kMillisecond)->Iterations(1);
  return true;
}

}  // namespace catena::bench
