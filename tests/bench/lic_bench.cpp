// SPDX-License-Identifier: MIT
/// Line integral convolution of 1024 x 768 texels in a grid of 256^3 vectors, nothing reused; a new phase of an animated texture costs
/// nothing here, because the slice's shader applies it.
#include <benchmark/benchmark.h>

#include "engine/field/analytic/analytic.h"
#include "engine/field/grid/grid.h"
#include "engine/geometry/flow/lic.h"

namespace {

using namespace catena;

const field::VectorGrid& grid() {
  static const auto made = field::sample_on_grid(*field::make_analytic("vortices")->vector, 256, -2, 2);
  return *made;
}

void compute(benchmark::State& state, const Vec3& u, const Vec3& v, bool animated) {
  const flow::LicPlane plane{-1.6 * u - 1.2 * v, u, v, 3.2 / 1024, 1024, 768, 0, 0};
  grid();
  for (auto _ : state) benchmark::DoNotOptimize(flow::compute_lic(grid(), plane, animated));
  state.counters["texels"] = plane.width * plane.height;
}

const Vec3 kAlong = direction(Vec3(1, 0.3, 0.5));
BENCHMARK_CAPTURE(compute, lic_axis, Vec3(1, 0, 0), Vec3(0, 1, 0), false)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(compute, lic_oblique, kAlong, direction(cross(Vec3(0.1, 0.4, 0.9), kAlong)), false)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(compute, lic_animated, Vec3(1, 0, 0), Vec3(0, 1, 0), true)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
