// SPDX-License-Identifier: MIT
/// Cost of a cutting plane in the tick of a streamline and an isosurface on 256^3 grids: away from it, on the plane, and turning.
#include "haptics/constraints/widget_link.h"
#include "tests/bench/chain_bench.h"

namespace widget_bench {

using namespace catena;
using namespace catena::bench;

HapticProgram program_with(int planes, const Vec3& centre) {
  HapticProgram program = make_pair_program();
  for (int i = 0; i < planes; ++i) {
    widget::Spec plane;
    plane.radius = 0.2;
    plane.snap = 0.5;
    plane.release = 1;
    plane.grab_distance = 0.05;
    plane.step = 0.08;
    plane.pose.points[0] = centre + Vec3(0.0, 0.0, 5.0 * i);
    program.widgets.push_back(plane);
    program.widget_names.push_back("cut" + std::to_string(i));
  }
  if (planes > 0) add_widget_links(program);
  return program;
}

[[maybe_unused]] const bool registered = register_benchmarks({
    {"TickWithoutWidgets", [](benchmark::State& state) { run_chain(state, program_with(0, Vec3(0.0))); }},
    {"TickCuttingPlaneAway", [](benchmark::State& state) { run_chain(state, program_with(1, Vec3(0.0, 0.0, 50.0))); }},
    {"TickCuttingPlaneExplored", [](benchmark::State& state) { run_chain(state, program_with(1, Vec3(-3.0, 0.0, 0.0))); }},
    {"TickEightCuttingPlanes", [](benchmark::State& state) { run_chain(state, program_with(8, Vec3(-3.0, 0.0, 0.0))); }},
});

}  // namespace widget_bench
