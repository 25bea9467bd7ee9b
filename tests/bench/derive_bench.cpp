// SPDX-License-Identifier: MIT
/// Derived fields of a grid of 256^3 vectors, beside plain loops over an array that compute the same on the same threads.
#include <benchmark/benchmark.h>

#include <cmath>

#include "engine/base/threads.h"
#include "engine/field/derived/derive.h"
#include "engine/field/grid/grid.h"

namespace {

using namespace catena;

constexpr int kNodes = 256;

const std::vector<float>& values() {
  static const std::vector<float> xyz = [] {
    std::vector<float> made;
    made.reserve(std::size_t{3} * kNodes * kNodes * kNodes);
    for (int z = 0; z < kNodes; ++z)
      for (int y = 0; y < kNodes; ++y)
        for (int x = 0; x < kNodes; ++x)
          for (const double v : {0.07 * y, 0.05 * z + 0.01 * x, 0.03 * x * y}) made.push_back(float(std::sin(v)));
    return made;
  }();
  return xyz;
}

/// Calls node(x, y, z, index, neighbors) for inner nodes, on all threads.
template <class Node>
void each_node(const Node& node) {
  parallel_for(kNodes - 2, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t z = begin + 1; z < end + 1; ++z)
      for (std::size_t y = 1; y + 1 < kNodes; ++y)
        for (std::size_t x = 1; x + 1 < kNodes; ++x) node((z * kNodes + y) * kNodes + x);
  });
}

double difference(const float* v, std::size_t at, std::size_t stride, std::size_t c) {
  return 0.5 * (double(v[3 * (at + stride) + c]) - double(v[3 * (at - stride) + c]));
}

void plain_loops(benchmark::State& state, bool is_vorticity) {
  const float* v = values().data();
  for (auto _ : state) {
    std::vector<float> out(std::size_t{is_vorticity ? 3u : 1u} * kNodes * kNodes * kNodes);
    each_node([&](std::size_t at) {
      constexpr std::size_t dx = 1, dy = kNodes, dz = std::size_t{kNodes} * kNodes;
      double j[3][3];
      for (std::size_t c = 0; c < 3; ++c) {
        j[c][0] = difference(v, at, dx, c);
        j[c][1] = difference(v, at, dy, c);
        j[c][2] = difference(v, at, dz, c);
      }
      if (is_vorticity) {
        out[3 * at] = float(j[2][1] - j[1][2]);
        out[3 * at + 1] = float(j[0][2] - j[2][0]);
        out[3 * at + 2] = float(j[1][0] - j[0][1]);
      } else {
        out[at] = float(-0.5 * (j[0][0] * j[0][0] + j[1][1] * j[1][1] + j[2][2] * j[2][2]) - j[0][1] * j[1][0] - j[0][2] * j[2][0] -
                        j[1][2] * j[2][1]);
      }
    });
    benchmark::DoNotOptimize(out.data());
  }
}

void derived(benchmark::State& state, field::Quantity quantity) {
  static const field::AnyField grid{nullptr, field::make_vector_grid("v", {}, {kNodes, kNodes, kNodes}, values())};
  for (auto _ : state) benchmark::DoNotOptimize(field::derive(grid, quantity, 2, "d").value().get());
}

BENCHMARK_CAPTURE(plain_loops, vorticity, true)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(derived, vorticity, field::Quantity::vorticity)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(plain_loops, q_criterion, false)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(derived, q_criterion, field::Quantity::q_criterion)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(derived, lambda2, field::Quantity::lambda2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
