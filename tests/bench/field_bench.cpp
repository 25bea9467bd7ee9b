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

void scalar_walk(benchmark::State& state) { fetch_all(state, scalar_grid(), walk(0.05)); }
void scalar_stride(benchmark::State& state) { fetch_all(state, scalar_grid(), walk(1)); }
void scalar_random(benchmark::State& state) { fetch_all(state, scalar_grid(), scattered()); }
void vector_walk(benchmark::State& state) { fetch_all(state, vector_grid(), walk(0.05)); }
void vector_random(benchmark::State& state) { fetch_all(state, vector_grid(), scattered()); }
void cubic_scalar_walk(benchmark::State& state) { fetch_all(state, cubic_scalar_grid(), walk(0.05)); }
void cubic_scalar_stride(benchmark::State& state) { fetch_all(state, cubic_scalar_grid(), walk(1)); }
void cubic_scalar_random(benchmark::State& state) { fetch_all(state, cubic_scalar_grid(), scattered()); }
void cubic_vector_walk(benchmark::State& state) { fetch_all(state, cubic_vector_grid(), walk(0.05)); }
void cubic_vector_random(benchmark::State& state) { fetch_all(state, cubic_vector_grid(), scattered()); }

BENCHMARK(scalar_walk);
BENCHMARK(scalar_stride);
BENCHMARK(scalar_random);
BENCHMARK(vector_walk);
BENCHMARK(vector_random);
BENCHMARK(cubic_scalar_walk);
BENCHMARK(cubic_scalar_stride);
BENCHMARK(cubic_scalar_random);
BENCHMARK(cubic_vector_walk);
BENCHMARK(cubic_vector_random);

}  // namespace field_bench
