// SPDX-License-Identifier: MIT
/// Every constraint alone, one benchmark each, on 256^3 grids for constraints of fields: nanoseconds per tick, and evaluations against
/// the budget of 257, as counters. Registered types without a link here are listed at the start.
#include <cstdio>

#include "tests/bench/chain_bench.h"

namespace constraint_bench {

using namespace catena;
using namespace catena::bench;

struct Example {
  const char *name, *body;
};

const Example kExamples[] = {
    {"point", R"("type": "point", "position": [0.5, 0, 0])"},
    {"line", R"("type": "line", "point": [0.5, 0, 0], "direction": [0, 1, 0.3])"},
    {"segment", R"("type": "segment", "from": [0.4, -0.5, 0], "to": [0.7, 0.5, 0.1])"},
    {"polyline", R"("type": "polyline", "points": [[0.4, -0.3, 0], [0.8, -0.2, 0.2], [0.7, 0.3, 0.1], [0.4, 0.2, -0.2]], "closed": true)"},
    {"plane", R"("type": "plane", "point": [0.6, 0, 0], "normal": [1, 2, 3], "free": "above")"},
    {"sphere", R"("type": "sphere", "center": [0, 0, 0], "radius": 0.6, "free": "above")"},
    {"box", R"("type": "box", "center": [0.6, 0, 0], "size": [0.3, 0.4, 0.2], "free": "above")"},
    {"isosurface", R"("type": "isosurface", "field": "torus", "level": 0.5)"},
    {"isosurface_free", R"("type": "isosurface", "field": "torus", "level": 0.5, "free": "above", "release": 0.3)"},
    {"streamline", R"("type": "streamline", "field": "hill", "seed": [0.5, 0, 0])"},
    {"streamline_online", R"("type": "streamline", "field": "hill", "seed": [0.5, 0, 0], "follow": "online")"},
    {"streamline_rk2", R"("type": "streamline", "field": "hill", "seed": [0.5, 0, 0], "method": "rk2")"},
    {"streamline_linear", R"("type": "streamline", "field": "hill", "seed": [0.5, 0, 0], "method": "linear")"},
    {"drag", R"("type": "drag", "threshold": 0.02)"},
    {"friction", R"("type": "friction", "field": "hill", "threshold": 0.02)"},
    {"modulated_friction", R"("type": "modulated_friction", "field": "hill", "surface": "torus")"},
    {"texture", R"("type": "texture", "threshold": 0.01, "wavelength": 0.05)"},
    {"viscosity", R"("type": "viscosity", "time": 0.02)"},
    {"gradient_force", R"("type": "gradient_force", "field": "torus", "displacement": 0.02, "direction": "down_gradient")"},
    {"vortex_core", R"("type": "vortex_core", "field": "lamb-oseen", "search_radius": 2)"},
    {"snap", R"("type": "streamline", "field": "hill", "seed": [0.5, 0, 0], "snap": 0.05, "release": 0.1)"},
    {"driven", R"("type": "drag", "threshold": {"field": "torus", "map": [[0, 0.001], [1, 0.05]]})"},
};

[[maybe_unused]] const bool registered = [] {
  for (const Example& example : kExamples) {
    benchmark::RegisterBenchmark((std::string("Constraint/") + example.name).c_str(), [&example](benchmark::State& state) {
      HapticProgram program;
      program.links = {make_link(std::string(R"({"name": "link", )") + example.body + "}")};
      run_chain(state, program);
    })->Unit(benchmark::kMillisecond);
  }
  for (const ConstraintType& type : constraint_types()) {
    const std::string word = "\"type\": \"" + std::string(type.type) + "\"";
    const bool there = std::any_of(std::begin(kExamples), std::end(kExamples),
                                   [&](const Example& e) { return std::string(e.body).find(word) != std::string::npos; });
    if (!there && type.type != "mesh") std::fprintf(stderr, "no benchmark of the constraint %s\n", std::string(type.type).c_str());
  }
  return true;
}();

}  // namespace constraint_bench
