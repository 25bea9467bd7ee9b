// SPDX-License-Identifier: MIT
#include "render/residency/cubic_cells.h"

#include <algorithm>
#include <vector>

namespace catena::render {
namespace {

constexpr int kControls = 3 * kBrickSize + 1;  // control points per axis: three per cell, and the last one

/// Converts a row of samples into Bezier control points of a cubic per cell; `step`: stride of both arrays, in floats.
void to_controls(const float* sample, float* control, std::size_t step) {
  for (int cell = 0; cell < kBrickSize; ++cell) {
    const float a = sample[cell * step], b = sample[(cell + 1) * step], c = sample[(cell + 2) * step], d = sample[(cell + 3) * step];
    float* out = control + 3 * cell * step;
    out[0] = b;
    out[step] = b + (c - a) / 6;
    out[2 * step] = c - (d - b) / 6;
    out[3 * step] = c;
  }
}

}  // namespace

std::array<std::uint8_t, kBrickSize * kBrickSize> find_cubic_cells(std::span<const float> samples, float value, float slack) {
  constexpr std::size_t n = kCubicSamples, m = kControls;
  CATENA_ASSERT(samples.size() >= n * n * n);
  std::vector<float> x(m * n * n), y(m * m * n), z(m * m * m);
  for (std::size_t row = 0; row < n * n; ++row) to_controls(&samples[row * n], &x[row * m], 1);
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < m; ++i) to_controls(&x[k * n * m + i], &y[k * m * m + i], m);
  for (std::size_t i = 0; i < m * m; ++i) to_controls(&y[i], &z[i], m * m);

  const float low = value - slack, high = value + slack;
  std::array<std::uint8_t, kBrickSize * kBrickSize> cells{};
  for (int k = 0; k < kBrickSize; ++k)
    for (int j = 0; j < kBrickSize; ++j)
      for (int i = 0; i < kBrickSize; ++i) {
        bool above = true, below = true;
        for (int c = 0; c < 16; ++c) {
          const float* row = &z[((3 * k + c / 4) * m + 3 * j + c % 4) * m + 3 * i];
          for (int r = 0; r < 4; ++r) {
            above = above && row[r] > high;
            below = below && row[r] < low;
          }
        }
        if (!above && !below) cells[j + kBrickSize * k] = std::uint8_t(cells[j + kBrickSize * k] | 1u << i);
      }
  return cells;
}

}  // namespace catena::render
