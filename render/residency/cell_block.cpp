// SPDX-License-Identifier: MIT
#include "render/residency/cell_block.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

namespace catena::render {

using field::Index3;

void CellBlock::read(const field::ScalarGrid& grid, const Index3& origin, const Index3& size, bool masked) {
  voxels = size;
  const std::size_t count = std::size_t(size.x) * size.y * size.z;
  values.resize(count);
  grid.read_block(origin, size, values);
  if (!masked) return;
  valid.resize(count);
  grid.read_cell_validity(origin, size, valid);
  for (int z = 0; z + 1 < size.z; ++z)
    for (int y = 0; y + 1 < size.y; ++y)
      for (int x = 0; x + 1 < size.x; ++x) {
        std::uint8_t& v = valid[voxel_index(x, y, z)];
        for (int c = 0; c < 8 && v; ++c) v = std::isfinite(values[voxel_index(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2))]);
      }
}

BrickRange CellBlock::compute_range(const Index3& first, const Index3& end, int margin) const {
  float min_value = std::numeric_limits<float>::infinity(), max_value = -min_value;
  const auto include_range = [&](const Index3& from, const Index3& to) {
    for (int z = from.z; z <= to.z; ++z)
      for (int y = from.y; y <= to.y; ++y)
        for (int x = from.x; x <= to.x; ++x) {
          const float v = values[voxel_index(x, y, z)];
          min_value = std::min(min_value, v);
          max_value = std::max(max_value, v);
        }
  };
  // fast path: in most bricks all cells are valid, or none
  std::size_t some = 0, count = 0;
  if (!valid.empty()) {
    for (int z = first.z; z < end.z; ++z)
      for (int y = first.y; y < end.y; ++y)
        for (int x = first.x; x < end.x; ++x, ++count) some += valid[voxel_index(x, y, z)] != 0;
  }
  if (some == count) {
    include_range({first.x - margin, first.y - margin, first.z - margin}, {end.x + margin, end.y + margin, end.z + margin});
  } else if (some > 0) {
    for (int z = first.z; z < end.z; ++z)
      for (int y = first.y; y < end.y; ++y)
        for (int x = first.x; x < end.x; ++x)
          if (valid[voxel_index(x, y, z)])
            include_range({x - margin, y - margin, z - margin}, {x + 1 + margin, y + 1 + margin, z + 1 + margin});
  }
  return min_value <= max_value ? BrickRange{min_value, max_value} : BrickRange{};
}

BrickRange widen_for_cubic(const BrickRange& r) {
  if (r.empty() || r.min == r.max) return r;
  const double beyond = field::kCubicOvershoot * (double(r.max) - r.min);
  const auto outwards = [](double v, float to) { return std::nextafter(float(std::clamp(v, -double{FLT_MAX}, double{FLT_MAX})), to); };
  return {outwards(r.min - beyond, -FLT_MAX), outwards(r.max + beyond, FLT_MAX)};
}

}  // namespace catena::render
