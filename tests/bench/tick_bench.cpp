// SPDX-License-Identifier: MIT
/// The tick of a streamline and an isosurface on 256^3 grids.
#include "tests/bench/chain_bench.h"

namespace tick_bench {

using namespace catena;
using namespace catena::bench;

constexpr const char* kSelected = R"({"name": "curve", "type": "streamline", "field": "hill", "seed": [0.5, 0, 0]})";
constexpr const char* kOnline = R"({"name": "curve", "type": "streamline", "field": "hill", "seed": [0.5, 0, 0], "follow": "online"})";
constexpr const char* kSurface = R"({"name": "surface", "type": "isosurface", "field": "torus", "level": 0.5})";

void run_with(benchmark::State& state, const char* curve) {
  HapticProgram program;
  program.links = {make_link(curve), make_link(kSurface)};
  run_chain(state, program);
}

/// With the additional work for a device: force limiter, ledger and passivity controller.
void with_limits(benchmark::State& state, const char* curve) {
  HapticProgram program;
  program.links = {make_link(curve), make_link(kSurface)};
  program.limits.max_stiffness_n_per_m = 400;
  program.limits.max_force_n = 6;
  program.limits.slew_n_per_s = 5000;
  program.limits.ramp_in_s = 0.5;
  program.limits.passivity_control = true;
  program.limits.damping_ns_per_m = 0.1;
  program.limits.delay_s = 5e-4;
  program.limits.max_added_damping_ns_per_m = 40;
  run_chain(state, program);
}

void TickEmpty(benchmark::State& state) { run_chain(state, HapticProgram{}); }
void TickSelectedStreamlineAndIsosurface256(benchmark::State& state) { run_with(state, kSelected); }
void TickOnlineStreamlineAndIsosurface256(benchmark::State& state) { run_with(state, kOnline); }
void TickSelectedStreamlineAndIsosurface256OnADevice(benchmark::State& state) { with_limits(state, kSelected); }
BENCHMARK(TickEmpty)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(TickSelectedStreamlineAndIsosurface256)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(TickSelectedStreamlineAndIsosurface256OnADevice)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(TickOnlineStreamlineAndIsosurface256)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace tick_bench
