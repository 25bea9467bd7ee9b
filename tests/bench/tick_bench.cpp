// SPDX-License-Identifier: MIT
/// The tick of a streamline and an isosurface on 256^3 grids.
#include "tests/bench/chain_bench.h"

namespace tick_bench {

using namespace catena;
using namespace catena::bench;

constexpr const char* kOnline = R"({"name": "curve", "type": "streamline", "field": "hill", "seed": [0.5, 0, 0], "follow": "online"})";

/// With the additional work for a device: force limiter, ledger and passivity controller.
void with_limits(benchmark::State& state) {
  HapticProgram program = make_pair_program();
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

[[maybe_unused]] const bool registered = register_benchmarks({
    {"TickEmpty", [](benchmark::State& state) { run_chain(state, HapticProgram{}); }},
    {"TickSelectedStreamlineAndIsosurface256", [](benchmark::State& state) { run_chain(state, make_pair_program()); }},
    {"TickSelectedStreamlineAndIsosurface256OnADevice", with_limits},
    {"TickOnlineStreamlineAndIsosurface256", [](benchmark::State& state) { run_chain(state, make_pair_program(kOnline)); }},
});

}  // namespace tick_bench
