// SPDX-License-Identifier: MIT
#include "haptics/chain/bricks.h"

#include <limits>

namespace catena::haptics {

namespace {

constexpr double kMarginVoxels = 2;
constexpr int kMaxBricksPerBox = 512;

/// Box in index space.
struct IndexBox {
  Vec3 lo, hi;
};

/// Returns whether a brick of the box differs; `too_many`: the box has more than kMaxBricksPerBox.
bool box_differs(const field::PagedGrid& grid, const field::BrickSnapshot* a, const field::BrickSnapshot* b, const IndexBox& box,
                 bool& too_many) noexcept {
  const field::Index3 lo = grid.brick_of(box.lo - Vec3(kMarginVoxels)), hi = grid.brick_of(box.hi + Vec3(kMarginVoxels));
  const double count = (hi.x - lo.x + 1.0) * (hi.y - lo.y + 1.0) * (hi.z - lo.z + 1.0);
  too_many = count > kMaxBricksPerBox;
  if (too_many) return false;
  for (int z = lo.z; z <= hi.z; ++z)
    for (int y = lo.y; y <= hi.y; ++y)
      for (int x = lo.x; x <= hi.x; ++x) {
        const field::BrickId id = grid.brick_id({x, y, z});
        if ((a != nullptr && a->find(id) != nullptr) != (b != nullptr && b->find(id) != nullptr)) return true;
      }
  return false;
}

}  // namespace

bool bricks_differ(std::span<const std::shared_ptr<const field::PagedGrid>> grids, const field::BrickSnapshot* a,
                   const field::BrickSnapshot* b, std::span<const Vec3> positions) noexcept {
  for (const auto& grid : grids) {
    IndexBox all{Vec3(std::numeric_limits<double>::infinity()), Vec3(-std::numeric_limits<double>::infinity())};
    for (const Vec3& position : positions) {
      if (!is_finite(position)) continue;
      const Vec3 index = grid->mapping().index_from_world(position);
      all.lo = glm::min(all.lo, index);
      all.hi = glm::max(all.hi, index);
    }
    bool too_many = false;
    if (box_differs(*grid, a, b, all, too_many)) return true;
    if (!too_many) continue;
    for (const Vec3& position : positions) {
      if (!is_finite(position)) continue;
      const Vec3 index = grid->mapping().index_from_world(position);
      if (box_differs(*grid, a, b, {index, index}, too_many)) return true;
    }
  }
  return false;
}

}  // namespace catena::haptics
