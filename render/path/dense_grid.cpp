// SPDX-License-Identifier: MIT
#include "render/path/dense_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/threads.h"
#include "render/residency/voxel_block.h"

namespace catena::render {

std::shared_ptr<const DenseGrid> DenseGrid::make(const field::ScalarGrid& grid) {
  auto made = std::make_shared<DenseGrid>();
  const VoxelExtent extent = voxel_extent(grid);
  made->size_ = {extent.size.x, extent.size.y, extent.size.z};
  made->lo_ = Vec3(extent.lo.x, extent.lo.y, extent.lo.z);
  made->mapping_ = grid.mapping();
  made->voxel_edge_ = grid.mapping().min_voxel_edge();
  made->is_nearest_ = grid.interpolation() == field::Interpolation::nearest;
  const std::size_t plane = std::size_t(extent.size.x) * std::size_t(extent.size.y), count = plane * std::size_t(extent.size.z);
  made->values_.resize(count);
  const bool is_masked = has_invalid_cells(grid);
  if (is_masked) made->valid_.resize(count);
  parallel_for(std::size_t(extent.size.z), 4, [&](std::size_t begin, std::size_t end) {
    const field::Index3 origin{extent.lo.x, extent.lo.y, int(extent.lo.z + std::int64_t(begin))},
        size{extent.size.x, extent.size.y, int(end - begin)};
    const std::size_t first = begin * plane, part = (end - begin) * plane;
    grid.read_block(origin, size, std::span(made->values_).subspan(first, part));
    if (is_masked) grid.read_cell_validity(origin, size, std::span(made->valid_).subspan(first, part));
  });
  made->find_ranges();
  return made;
}

void DenseGrid::find_ranges() {
  if (*std::ranges::min_element(size_) < 2) return;
  for (std::size_t a = 0; a < 3; ++a) bricks_[a] = (size_[a] - 2) / kBrick + 1;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  ranges_.assign(std::size_t(bricks_[0]) * std::size_t(bricks_[1]) * std::size_t(bricks_[2]), {kInfinity, -kInfinity});
  parallel_for(ranges_.size(), 64, [&](std::size_t begin, std::size_t end) {
    std::array<float, 8> corner{};
    for (std::size_t b = begin; b < end; ++b) {
      const int bx = int(b % std::size_t(bricks_[0])), by = int(b / std::size_t(bricks_[0]) % std::size_t(bricks_[1])),
                bz = int(b / std::size_t(bricks_[0]) / std::size_t(bricks_[1]));
      auto& [lowest, highest] = ranges_[b];
      for (int z = bz * kBrick; z < std::min((bz + 1) * kBrick, size_[2] - 1); ++z)
        for (int y = by * kBrick; y < std::min((by + 1) * kBrick, size_[1] - 1); ++y)
          for (int x = bx * kBrick; x < std::min((bx + 1) * kBrick, size_[0] - 1); ++x) {
            if (!is_valid_cell(x, y, z)) continue;
            corners(x, y, z, corner);
            for (const float value : corner) {
              lowest = std::min(lowest, value);
              highest = std::max(highest, value);
            }
          }
    }
  });
}

void DenseGrid::corners(int x, int y, int z, std::array<float, 8>& out) const {
  const float* at = &values_[index(x, y, z)];
  const auto row = std::size_t(size_[0]), plane = row * std::size_t(size_[1]);
  out = {at[0], at[1], at[row], at[row + 1], at[plane], at[plane + 1], at[plane + row], at[plane + row + 1]};
}

bool DenseGrid::sample(const glm::vec3& p, float& value) const {
  int base[3];
  float f[3];
  for (int a = 0; a < 3; ++a) {
    const float at = std::clamp(p[a], 0.0f, float(size_[std::size_t(a)] - 1));
    base[a] = std::min(int(at), size_[std::size_t(a)] - 2);
    f[a] = at - float(base[a]);
  }
  const std::size_t first = index(base[0], base[1], base[2]);
  if (!valid_.empty() && valid_[first] == 0) return false;
  const auto row = std::size_t(size_[0]), plane = row * std::size_t(size_[1]);
  const float* v = &values_[first];
  if (is_nearest_) {
    value = v[(f[0] >= 0.5f ? 1 : 0) + (f[1] >= 0.5f ? row : 0) + (f[2] >= 0.5f ? plane : 0)];
    return true;
  }
  const auto mix = [](float a, float b, float t) { return a + (b - a) * t; };
  const float near = mix(mix(v[0], v[1], f[0]), mix(v[row], v[row + 1], f[0]), f[1]);
  const float* w = v + plane;
  value = mix(near, mix(mix(w[0], w[1], f[0]), mix(w[row], w[row + 1], f[0]), f[1]), f[2]);
  return true;
}

Vec3 DenseGrid::gradient(const glm::vec3& p) const {
  if (is_nearest_) return Vec3(0.0);
  Vec3 g(0.0);
  for (int a = 0; a < 3; ++a) {
    glm::vec3 before = p, after = p;
    const auto most = float(size_[std::size_t(a)] - 1);
    before[a] = std::max(0.0f, p[a] - 1);
    after[a] = std::min(most, p[a] + 1);
    float lower = 0, upper = 0, here = 0;
    const bool has_lower = sample(before, lower), has_upper = sample(after, upper);
    if (!has_lower || !has_upper) sample(p, here);
    const float from = has_lower ? before[a] : p[a], to = has_upper ? after[a] : p[a];
    if (to > from) g[a] = double((has_upper ? upper : here) - (has_lower ? lower : here)) / double(to - from);
  }
  return mapping_.world_from_index_gradient(g);
}

}  // namespace catena::render
