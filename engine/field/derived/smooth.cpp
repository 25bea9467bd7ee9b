// SPDX-License-Identifier: MIT
// Gaussian smoothing of a grid, axis by axis: the sum of weights times values divided by the sum of the weights of nodes with a value.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/memory_limit.h"
#include "engine/base/threads.h"
#include "engine/field/derived/derive.h"
#include "engine/field/derived/node_slab.h"
#include "engine/field/grid/grid_storage.h"

namespace catena::field {
namespace {

constexpr double kReachSigmas = 4;  // standard deviations

std::vector<float> weights_of(double sigma_voxels) {
  const int reach = int(std::ceil(kReachSigmas * sigma_voxels));
  std::vector<double> weights;
  double sum = 0;
  for (int k = -reach; k <= reach; ++k) sum += weights.emplace_back(std::exp(-0.5 * k * k / (sigma_voxels * sigma_voxels)));
  std::vector<float> normalized;
  for (const double weight : weights) normalized.push_back(float(weight / sum));
  return normalized;
}

/// Replaces `length` rows, `stride` apart, by the weighted sums of the rows around them.
void filter_rows(float* first, int length, std::ptrdiff_t stride, std::size_t row, const std::vector<float>& weights,
                 std::vector<float>& copy) {
  const int reach = int(weights.size()) / 2;
  copy.resize(std::size_t(length) * row);
  for (int i = 0; i < length; ++i) std::copy_n(first + i * stride, row, copy.data() + std::size_t(i) * row);
  for (int i = 0; i < length; ++i) {
    float* out = first + i * stride;
    std::fill_n(out, row, 0.0f);
    for (int k = std::max(-reach, -i); k <= std::min(reach, length - 1 - i); ++k) {
      const float weight = weights[std::size_t(k + reach)];
      const float* in = copy.data() + std::size_t(i + k) * row;
      for (std::size_t x = 0; x < row; ++x) out[x] += weight * in[x];
    }
  }
}

void filter(std::vector<float>& values, const Index3& size, const std::array<std::vector<float>, 3>& weights) {
  const auto nx = std::size_t(size.x);
  const std::ptrdiff_t plane = std::ptrdiff_t(nx) * size.y;
  parallel_for(std::size_t(size.z), 1, [&](std::size_t begin, std::size_t end) {
    std::vector<float> copy;
    for (std::size_t z = begin; z < end; ++z) {
      float* slice = values.data() + std::ptrdiff_t(z) * plane;
      for (int y = 0; y < size.y; ++y) filter_rows(slice + y * std::ptrdiff_t(nx), size.x, 1, 1, weights[0], copy);
      filter_rows(slice, size.y, std::ptrdiff_t(nx), nx, weights[1], copy);
    }
  });
  parallel_for(std::size_t(size.y), 1, [&](std::size_t begin, std::size_t end) {
    std::vector<float> copy;
    for (std::size_t y = begin; y < end; ++y) filter_rows(values.data() + y * nx, size.z, plane, nx, weights[2], copy);
  });
}

template <class Grid>
Result<AnyField> smooth_grid(const Grid& grid, double sigma, const std::string& name) {
  constexpr std::size_t C = NodeSlab<Grid>::C;
  std::array<std::vector<float>, 3> weights;
  for (int a = 0; a < 3; ++a) {
    const double voxels = sigma / norm(grid.mapping().world_from_index_linear[a]);
    if (!(voxels <= kMaxSmoothing))
      return Error{
          fmt::format("a standard deviation of {:g} is {:.3g} voxels; at most {:g} voxels were expected", sigma, voxels, kMaxSmoothing)};
    weights[std::size_t(a)] = weights_of(std::max(voxels, 1e-3));
  }
  NodeSlab<Grid> slab(grid, 0);
  const Index3 size = slab.size();
  const std::size_t plane = std::size_t(size.x) * std::size_t(size.y), count = plane * std::size_t(size.z);
  constexpr double kBytesPerNode = 4.0 * (2 * C + 2) + 2;  // values, weights, the grid that is made of them, its mask
  CATENA_CHECK(check_memory_available("the smoothed field", kBytesPerNode * double(count)));
  std::array<std::vector<float>, C> sums;
  for (auto& component : sums) component.resize(count);
  std::vector<float> weight(count, 1.0f);
  constexpr int kLayers = 8;
  for (int z = 0; z < size.z; z += kLayers) {
    const int layers = std::min(kLayers, size.z - z);
    slab.read(z, layers);
    parallel_for(std::size_t(layers), 1, [&](std::size_t begin, std::size_t end) {
      for (int layer = z + int(begin); layer < z + int(end); ++layer)
        for (int y = 0; y < size.y; ++y)
          for (int x = 0; x < size.x; ++x) {
            const std::size_t at = std::size_t(layer) * plane + std::size_t(y) * std::size_t(size.x) + std::size_t(x);
            const bool counts = slab.is_valid(x, y, layer);
            if (!counts) weight[at] = 0;
            for (std::size_t c = 0; c < C; ++c) sums[c][at] = counts ? float(slab.value(int(c), x, y, layer)) : 0.0f;
          }
    });
  }
  std::vector<std::uint8_t> valid, cells;
  if (grid.has_mask())
    for (const float w : weight) valid.push_back(w > 0 ? 1 : 0);
  if (slab.has_cell_mask())
    for (std::size_t i = 0; i < count; ++i)
      cells.push_back(slab.may_be_cell(int(i % std::size_t(size.x)), int(i / std::size_t(size.x)) % size.y, int(i / plane)) ? 1 : 0);
  for (auto& component : sums) filter(component, size, weights);
  filter(weight, size, weights);
  std::vector<float> values(C * count);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < C; ++c) values[C * i + c] = weight[i] > 0 ? sums[c][i] / weight[i] : 0.0f;
  Mapping mapping = grid.mapping();
  mapping.origin = mapping.world_from_index(grid.index_box().lo);
  if constexpr (C == 1)
    return AnyField{make_scalar_grid(name, mapping, size, values, valid, cells), nullptr};
  else
    return AnyField{nullptr, make_vector_grid(name, mapping, size, values, valid, cells)};
}

}  // namespace

Result<AnyField> smooth(const AnyField& field, double sigma, const std::string& name) {
  if (field.scalar && field.scalar->grid()) return smooth_grid(*field.scalar->grid(), sigma, name);
  if (field.vector && field.vector->grid()) return smooth_grid(*field.vector->grid(), sigma, name);
  return Error{"a formula has no nodes; a field on a grid was expected"};
}

}  // namespace catena::field
