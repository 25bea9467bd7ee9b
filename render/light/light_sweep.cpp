// SPDX-License-Identifier: MIT
#include "render/light/light_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/base/result.h"
#include "engine/base/threads.h"

namespace catena::render {

namespace {

/// Cells in the order of a sweep: planes across the main axis, rows along u.
struct SweepOrder {
  int main, u, v;
  std::size_t planes, width, height;
  std::size_t stride[3];  ///< of the cells, along x, y, z

  SweepOrder(const LightCells& cells, int main_axis)
      : main(main_axis), u(main == 0 ? 1 : 0), v(main == 2 ? 1 : 2), stride{1, std::size_t(cells.size.x), 0} {
    stride[2] = stride[1] * std::size_t(cells.size.y);
    const std::size_t n[3] = {std::size_t(cells.size.x), std::size_t(cells.size.y), std::size_t(cells.size.z)};
    planes = n[main], width = n[u], height = n[v];
  }
  /// Calls body(cell, first, count) for each row in the order of the sweep: the first cell in LightCells, and its place in the sweep.
  template <class Body>
  void each_row(const Body& body) const {
    parallel_for(planes, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        for (std::size_t j = 0; j < height; ++j) body(stride[main] * k + stride[v] * j, (k * height + j) * width);
    });
  }
};

int main_axis(const Vec3& v) {
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (std::fabs(v[a]) > std::fabs(v[axis])) axis = a;
  return axis;
}

/// Returns the transmittance of half of a step between two planes, in the order of the sweep. `along`: component of the direction along the
/// main axis.
std::vector<float> half_transmittances(const LightCells& cells, const SweepOrder& order, double along) {
  const auto half_step = float(0.5 * cells.edge / along);
  std::vector<float> halves(cells.count());
  order.each_row([&](std::size_t cell, std::size_t first) {
    for (std::size_t i = 0; i < order.width; ++i, cell += order.stride[order.u])
      halves[first + i] = cells.extinction[cell] > 0 ? std::exp(-cells.extinction[cell] * half_step) : 1;
  });
  return halves;
}

/// Direction of a sweep, and the weights of what arrives in the sums.
template <std::size_t Sums>
struct WeightedDirection {
  Vec3 to_light;
  std::array<float, Sums> weights;
};

/// Adds weights[n] * share of the light that arrives to sums[n], for several directions with equal components along the main axis; all in
/// the order of the sweep.
template <std::size_t Directions, std::size_t Sums>
void add_sweeps(const LightCells& cells, const SweepOrder& order, const std::vector<float>& halves,
                const std::array<WeightedDirection<Sums>, Directions>& directions, double reach,
                std::array<std::vector<float>, Sums>& sums) {
  const double main = directions[0].to_light[order.main], along = std::fabs(main);
  const bool from_top = main > 0;
  const auto decay = float(std::exp(-cells.edge / along / reach)), rest = 1 - decay;
  // what leaves the cells of the previous plane and of this one, with a border where everything arrives
  constexpr std::size_t kBorder = 2;
  const std::size_t row = order.width + 2 * kBorder;
  struct Way {
    int du, dv;
    float w00, w10, w01, w11;
    std::vector<float> before, leaving, arriving;
  };
  std::array<Way, Directions> ways;
  for (std::size_t d = 0; d < Directions; ++d) {
    const Vec3& to = directions[d].to_light;
    const double shift_u = to[order.u] / along, shift_v = to[order.v] / along;  // from p to q, in cells
    Way& way = ways[d];
    way.du = int(std::floor(shift_u)), way.dv = int(std::floor(shift_v));
    const auto fu = float(shift_u - way.du), fv = float(shift_v - way.dv);
    way.w00 = decay * (1 - fu) * (1 - fv), way.w10 = decay * fu * (1 - fv), way.w01 = decay * (1 - fu) * fv, way.w11 = decay * fu * fv;
    way.before.assign(row * (order.height + 2 * kBorder), 1.0f);
    way.leaving = way.before;
    way.arriving.resize(order.width);
  }
  for (std::size_t k = 0; k < order.planes; ++k) {
    const std::size_t plane = (from_top ? order.planes - 1 - k : k) * order.height * order.width;
    for (std::size_t j = 0; j < order.height; ++j) {
      const float* __restrict half = &halves[plane + j * order.width];
      for (Way& way : ways) {
        const float* __restrict lower =
            &way.before[std::size_t(std::ptrdiff_t(j + kBorder) + way.dv) * row + std::size_t(std::ptrdiff_t(kBorder) + way.du)];
        const float* __restrict upper = lower + row;
        float* __restrict out = &way.leaving[(j + kBorder) * row + kBorder];
        float* __restrict arrives = way.arriving.data();
        for (std::size_t i = 0; i < order.width; ++i) {
          const float here = (rest + way.w00 * lower[i] + way.w10 * lower[i + 1] + way.w01 * upper[i] + way.w11 * upper[i + 1]) * half[i];
          arrives[i] = here;
          out[i] = here * half[i];
        }
      }
      for (std::size_t n = 0; n < Sums; ++n) {
        float* __restrict to = &sums[n][plane + j * order.width];
        for (std::size_t d = 0; d < Directions; ++d) {
          const float* __restrict arrives = ways[d].arriving.data();
          const float weight = directions[d].weights[n];
          for (std::size_t i = 0; i < order.width; ++i) to[i] += weight * arrives[i];
        }
      }
    }
    for (Way& way : ways) std::swap(way.before, way.leaving);
  }
}

/// Adds values in the order of a sweep to those of the cells.
void add_ordered(const SweepOrder& order, const std::vector<float>& values, std::vector<float>& cells) {
  order.each_row([&](std::size_t cell, std::size_t first) {
    for (std::size_t i = 0; i < order.width; ++i, cell += order.stride[order.u]) cells[cell] += values[first + i];
  });
}

}  // namespace

std::vector<float> sweep_light(const LightCells& cells, const Vec3& to_light, double angular_size_deg) {
  // points of the disc along a spiral, each of the same area
  constexpr int kLeastPoints = 4, kMostPoints = 12;
  constexpr double kPointsPerDegree = 0.6;
  constexpr double kGoldenAngle = 2.399963229728653;
  const int count = angular_size_deg > 0 ? std::clamp(int(std::ceil(kPointsPerDegree * angular_size_deg)), kLeastPoints, kMostPoints) : 1;
  const double radius = std::tan(0.5 * angular_size_deg * std::numbers::pi / 180);
  const Vec3 u = direction(cross(to_light, std::fabs(to_light.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0))), v = cross(to_light, u);
  // two sums, so that the result does not depend on the threads
  std::vector<float> parts[2];
  parallel_for(2, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = begin; part < end; ++part) {
      parts[part].assign(cells.count(), 0);
      for (int k = int(part); k < count; k += 2) {
        const double r = count > 1 ? radius * std::sqrt((k + 0.5) / count) : 0, angle = kGoldenAngle * k;
        const Vec3 to = direction(to_light + r * (std::cos(angle) * u + std::sin(angle) * v));
        const SweepOrder order(cells, main_axis(to));
        std::array<std::vector<float>, 1> ordered{std::vector<float>(cells.count())};
        add_sweeps<1, 1>(cells, order, half_transmittances(cells, order, std::fabs(to[order.main])), {{{to, {1 / float(count)}}}},
                         std::numeric_limits<double>::infinity(), ordered);
        add_ordered(order, ordered[0], parts[part]);
      }
    }
  });
  for (std::size_t i = 0; i < parts[0].size(); ++i) parts[0][i] += parts[1][i];
  return std::move(parts[0]);
}

std::array<std::vector<float>, 4> sweep_environment(const LightCells& cells, double reach) {
  // the rotations of one direction by the symmetries of the cube: a spherical design of degree 7 (McLaren 1963), none of which lies in a
  // plane of cells. Even permutations with an even number of signs, and odd ones with an odd number; by the axis of the largest component
  constexpr double kSquares[3] = {0.7503, 0.1786, 0.0711};
  constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  std::vector<Vec3> directions[3];
  for (int order = 0; order < 6; ++order)
    for (int signs = 0; signs < 8; ++signs) {
      const int negative = (signs & 1) + (signs >> 1 & 1) + (signs >> 2);
      if (negative % 2 != (order < 3 ? 0 : 1)) continue;
      Vec3 to;
      for (int a = 0; a < 3; ++a) to[a] = std::sqrt(kSquares[kOrders[order][a]]) * ((signs >> a & 1) != 0 ? -1 : 1);
      directions[main_axis(to)].push_back(direction(to));
    }
  using Moments = std::array<std::vector<float>, 4>;
  const auto zeros = [&] {
    Moments moments;
    for (std::vector<float>& one : moments) one.resize(cells.count());
    return moments;
  };
  Moments sum = zeros();
  std::array<Moments, 2> parts{zeros(), zeros()};
  for (int axis = 0; axis < 3; ++axis) {
    const SweepOrder order(cells, axis);
    const std::vector<Vec3>& own = directions[axis];
    const std::vector<float> halves = half_transmittances(cells, order, std::fabs(own.front()[axis]));
    // one sum from either side, so that the result does not depend on the threads
    parallel_for(2, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t part = begin; part < end; ++part) {
        for (std::vector<float>& one : parts[part]) std::ranges::fill(one, 0.0f);
        std::array<WeightedDirection<4>, 4> side;
        std::size_t count = 0;
        for (const Vec3& to : own) {
          const glm::vec3 first(to * (3.0 / 24));
          if ((to[axis] > 0) == (part == 0)) side[count++] = {to, {1.0f / 24, first.x, first.y, first.z}};
        }
        CATENA_ASSERT(count == side.size());
        add_sweeps(cells, order, halves, side, reach, parts[part]);
      }
    });
    parallel_for(cells.count(), std::size_t{1} << 15, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = 0; n < 4; ++n) {
        float* __restrict to = parts[0][n].data();
        const float* __restrict from = parts[1][n].data();
        for (std::size_t k = begin; k < end; ++k) to[k] += from[k];
      }
    });
    for (std::size_t n = 0; n < 4; ++n) add_ordered(order, parts[0][n], sum[n]);
  }
  return sum;
}

}  // namespace catena::render
