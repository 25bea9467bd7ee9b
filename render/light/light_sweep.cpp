// SPDX-License-Identifier: MIT
#include "render/light/light_sweep.h"

#include <algorithm>
#include <cmath>

#include "engine/base/threads.h"

namespace catena::render {

namespace {

/// Returns the transmittance of half of a step between two planes, for each cell. `along`: component of the direction along the main axis.
std::vector<float> half_transmittances(const LightCells& cells, double along) {
  const auto half_step = float(0.5 * cells.edge / along);
  std::vector<float> halves(cells.count());
  parallel_for(halves.size(), std::size_t{1} << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) halves[i] = cells.extinction[i] > 0 ? std::exp(-cells.extinction[i] * half_step) : 1;
  });
  return halves;
}

double main_component(const Vec3& v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

void sweep(const LightCells& cells, const std::vector<float>& halves, const Vec3& to_light, double reach, std::vector<float>& arriving) {
  const int n[3] = {cells.size.x, cells.size.y, cells.size.z};
  const std::size_t stride[3] = {1, std::size_t(n[0]), std::size_t(n[0]) * std::size_t(n[1])};
  // planes across the main axis, rows along u
  int main = 0;
  for (int a = 1; a < 3; ++a)
    if (std::fabs(to_light[a]) > std::fabs(to_light[main])) main = a;
  const int u = main == 0 ? 1 : 0, v = main == 2 ? 1 : 2;
  const bool from_top = to_light[main] > 0;
  const double along = std::fabs(to_light[main]);
  const auto decay = float(std::exp(-cells.edge / along / reach));
  const double shift_u = to_light[u] / along, shift_v = to_light[v] / along;  // from p to q, in cells
  const int du = int(std::floor(shift_u)), dv = int(std::floor(shift_v));
  const auto fu = float(shift_u - du), fv = float(shift_v - dv);
  const std::size_t width = std::size_t(n[u]), height = std::size_t(n[v]);
  // what leaves the cells of the previous plane and of this one, with a border where everything arrives
  constexpr std::size_t kBorder = 2;
  const std::size_t row = width + 2 * kBorder;
  std::vector<float> before(row * (height + 2 * kBorder), 1.0f), leaving = before;
  arriving.resize(cells.count());
  for (int k = 0; k < n[main]; ++k) {
    const std::size_t plane = stride[main] * std::size_t(from_top ? n[main] - 1 - k : k);
    for (std::size_t j = 0; j < height; ++j) {
      const float* q = &before[std::size_t(std::ptrdiff_t(j + kBorder) + dv) * row + std::size_t(std::ptrdiff_t(kBorder) + du)];
      float* out = &leaving[(j + kBorder) * row + kBorder];
      std::size_t cell = plane + stride[v] * j;
      for (std::size_t i = 0; i < width; ++i, cell += stride[u]) {
        const float below = q[i] + fu * (q[i + 1] - q[i]), above = q[i + row] + fu * (q[i + row + 1] - q[i + row]);
        const float here = (1 - decay * (1 - (below + fv * (above - below)))) * halves[cell];
        arriving[cell] = here;
        out[i] = here * halves[cell];
      }
    }
    std::swap(before, leaving);
  }
}

}  // namespace

std::vector<float> sweep_light(const LightCells& cells, const Vec3& to_light, double reach) {
  std::vector<float> arriving;
  sweep(cells, half_transmittances(cells, main_component(to_light)), to_light, reach, arriving);
  return arriving;
}

std::vector<float> sweep_environment(const LightCells& cells, double reach) {
  // the rotations of one direction by the symmetries of the cube: a spherical design of degree 7 (McLaren 1963), none of which lies in a
  // plane of cells. Even permutations with an even number of signs, and odd ones with an odd number
  constexpr double kSquares[3] = {0.7503, 0.1786, 0.0711};
  std::vector<Vec3> directions;
  constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int order = 0; order < 6; ++order)
    for (int signs = 0; signs < 8; ++signs) {
      const int negative = (signs & 1) + (signs >> 1 & 1) + (signs >> 2);
      if (negative % 2 != (order < 3 ? 0 : 1)) continue;
      Vec3 to;
      for (int a = 0; a < 3; ++a) to[a] = std::sqrt(kSquares[kOrders[order][a]]) * ((signs >> a & 1) != 0 ? -1 : 1);
      directions.push_back(direction(to));
    }
  const std::vector<float> halves = half_transmittances(cells, main_component(directions.front()));
  std::vector<float> sum(cells.count());
  const float weight = 1 / float(directions.size());
  // a few at a time; summed in their order, so that the sum does not depend on the threads
  constexpr std::size_t kGroup = 4;
  std::vector<std::vector<float>> shares(kGroup);
  for (std::size_t first = 0; first < directions.size(); first += kGroup) {
    parallel_for(kGroup, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) sweep(cells, halves, directions[first + i], reach, shares[i]);
    });
    parallel_for(sum.size(), std::size_t{1} << 16, [&](std::size_t begin, std::size_t end) {
      for (const std::vector<float>& share : shares)
        for (std::size_t i = begin; i < end; ++i) sum[i] += weight * share[i];
    });
  }
  return sum;
}

double open_environment(double height, double reach) {
  // 1 - E2(height / reach) / 2, over the cosine of the angle to the normal
  constexpr int kSteps = 1000;
  double lost = 0;
  for (int i = 0; i < kSteps; ++i) lost += std::exp(-height / (reach * (i + 0.5) / kSteps)) / kSteps;
  return 1 - 0.5 * lost;
}

}  // namespace catena::render
