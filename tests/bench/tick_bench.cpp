/// The tick of a streamline and an isosurface on 256^3 grids.
#include "tests/bench/chain_bench.h"

namespace {

using namespace catena;
using namespace catena::bench;

constexpr const char* kSelected = R"({"name": "curve", "type": "streamline", "field": "hill", "seed": [0.5, 0, 0]})";
constexpr const char* kOnline = R"({"name": "curve", "type": "streamline", "field": "hill", "seed": [0.5, 0, 0], "follow": "online"})";
constexpr const char* kSurface = R"({"name": "surface", "type": "isosurface", "field": "torus", "level": 0.5})";

void run_with(benchmark::State& state, const char* curve) {
  Program program;
  program.links = {make_link(curve), make_link(kSurface)};
  run_chain(state, program);
}

void TickEmpty(benchmark::State& state) { run_chain(state, Program{}); }
void TickSelectedStreamlineAndIsosurface256(benchmark::State& state) { run_with(state, kSelected); }
void TickOnlineStreamlineAndIsosurface256(benchmark::State& state) { run_with(state, kOnline); }
BENCHMARK(TickEmpty)->Unit(benchmark::kMillisecond);
BENCHMARK(TickSelectedStreamlineAndIsosurface256)->Unit(benchmark::kMillisecond);
BENCHMARK(TickOnlineStreamlineAndIsosurface256)->Unit(benchmark::kMillisecond);

}  // namespace
