// SPDX-License-Identifier: MIT
#include "engine/io/chunks/pyramid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"

namespace catena::chunks {

using field::Index3;
using field::StoreGrid;
using field::StoreLevel;

field::StoreLevel make_level(const StoreGrid& grid, const Index3& size, const Index3& chunk, Vec3 spacing, Vec3 origin) {
  const int own[3] = {size.x, size.y, size.z};
  for (int a = 0; a < 3; ++a) {
    if (spacing[a] > 0) continue;
    spacing[a] = 1;
    if (grid.levels.empty()) continue;
    const StoreLevel& finest = grid.levels.front();
    const int full[3] = {finest.size.x, finest.size.y, finest.size.z};
    const double ratio = static_cast<double>(full[a]) / own[a], edge = finest.mapping.world_from_index_linear[a][a];
    spacing[a] = ratio * edge;
    origin[a] = finest.mapping.origin[a] + (ratio - 1) / 2 * edge;
  }
  Mat3 linear(0.0);
  for (int a = 0; a < 3; ++a) linear[a][a] = spacing[a];
  return {size, chunk, field::Mapping::from_linear(linear, origin)};
}

std::string remove_misplaced_levels(StoreGrid& grid) {
  const StoreLevel finest = grid.levels.front();
  const auto is_misplaced = [&](const StoreLevel& level) {
    const int full[3] = {finest.size.x, finest.size.y, finest.size.z}, own[3] = {level.size.x, level.size.y, level.size.z};
    for (int a = 0; a < 3; ++a) {
      const double fine_edge = finest.mapping.world_from_index_linear[a][a], edge = level.mapping.world_from_index_linear[a][a];
      constexpr double kVoxels = 2;
      const double lo = finest.mapping.origin[a] - fine_edge / 2, hi = lo + full[a] * fine_edge;
      const double own_lo = level.mapping.origin[a] - edge / 2, own_hi = own_lo + own[a] * edge;
      if (!(std::fabs(own_lo - lo) <= kVoxels * edge && std::fabs(own_hi - hi) <= kVoxels * edge)) return true;
      if (!(edge >= fine_edge * (1 - 1e-6))) return true;
    }
    return false;
  };
  const auto first = std::find_if(grid.levels.begin() + 1, grid.levels.end(), is_misplaced);
  if (first == grid.levels.end()) return {};
  const auto at = first - grid.levels.begin(), count = static_cast<std::ptrdiff_t>(grid.levels.size());
  grid.levels.erase(first, grid.levels.end());
  return fmt::format("level {} of {} of {} does not cover the same box as level 0: it and coarser ones are not used", at, count,
                     in_quotes(grid.name));
}

std::string unique_name(const field::StoreDescription& store, const std::string& name) {
  return make_unique_name(name, [&](const std::string& taken) { return std::ranges::count(store.grids, taken, &StoreGrid::name) > 0; });
}

}  // namespace catena::chunks
