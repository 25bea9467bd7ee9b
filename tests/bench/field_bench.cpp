// SPDX-License-Identifier: MIT
// One sample of value and gradient, linear and cubic, on a haptic walk (steps of 0.05 voxel) and at random positions of a 256^3 grid.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "engine/field/analytic/analytic.h"
#include "engine/field/grid/grid.h"

namespace field_bench {

using namespace catena;

constexpr int resolution = 256;

const field::ScalarGrid& scalar_grid() {
  static const auto grid = field::sample_on_grid(*field::make_analytic("marschner-lobb").value().scalar, resolution, -2, 2);
  return *grid;
}

const field::VectorGrid& vector_grid() {
  static const auto grid = field::sample_on_grid(*field::make_analytic("abc").value().vector, resolution, -2, 2);
  return *grid;
}

const field::ScalarGrid& cubic_scalar_grid() {
  static const auto grid = scalar_grid().as_cubic().value();
  return *grid;
}

const field::VectorGrid& cubic_vector_grid() {
  static const auto grid = vector_grid().as_cubic().value();
  return *grid;
}

/// A closed path through many cells; `step` in voxels.
std::vector<Vec3> walk(double step) {
  std::vector<Vec3> points;
  const double h = step * 4 / (resolution - 1);
  for (int n = 0; n < 20000; ++n) points.push_back(Vec3(1.5 * std::sin(h * n), std::cos(0.7 * h * n), 0.4 * std::sin(1.3 * h * n)));
  return points;
}

std::vector<Vec3> scattered() {
  std::vector<Vec3> points;
  std::uint64_t s = 1;
  const auto next = [&] {
    s = s * 6364136223846793005ull + 1442695040888963407ull;
    return -2 + 4 * (static_cast<double>(s >> 11) * 0x1p-53);
  };
  for (int n = 0; n < 200000; ++n) points.push_back(Vec3(next(), next(), next()));
  return points;
}

template <class Grid>
void fetch_all(benchmark::State& state, const Grid& grid, const std::vector<Vec3>& points) {
  field::Cursor cursor;
  for (auto _ : state)
    for (const Vec3& p : points) benchmark::DoNotOptimize(grid.sample(p, cursor));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
  state.counters["ns_per_fetch"] = benchmark::Counter(static_cast<double>(points.size()) * 1e-9,
                                                      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// The fields are sampled on first use.
template <class Grid>
bool add(const char* name, const Grid& (*grid)(), std::vector<Vec3> points) {
  benchmark::RegisterBenchmark(name, [=](benchmark::State& state) { fetch_all(state, grid(), points); });
  return true;
}

[[maybe_unused]] const bool registered =
    add("scalar_walk", scalar_grid, walk(0.05)) && add("scalar_stride", scalar_grid, walk(1)) &&
    add("scalar_random", scalar_grid, scattered()) && add("vector_walk", vector_grid, walk(0.05)) &&
    add("vector_random", vector_grid, scattered()) && add("cubic_scalar_walk", cubic_scalar_grid, walk(0.05)) &&
    add("cubic_scalar_stride", cubic_scalar_grid, walk(1)) && add("cubic_scalar_random", cubic_scalar_grid, scattered()) &&
    add("cubic_vector_walk", cubic_vector_grid, walk(0.05)) && add("cubic_vector_random", cubic_vector_grid, scattered());

}  // namespace field_bench
