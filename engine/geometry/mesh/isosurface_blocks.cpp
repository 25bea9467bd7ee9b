// SPDX-License-Identifier: MIT
#include "engine/geometry/mesh/isosurface_blocks.h"

#include <fmt/format.h>

#include <utility>

namespace catena::mesh {

using field::Index3;

Result<SurfaceBlocks> SurfaceBlocks::of(const field::ScalarGrid& grid, double level, const std::string& name) {
  const Vec3 &lo = grid.index_box().lo, &hi = grid.index_box().hi;
  SurfaceBlocks blocks(grid, level);
  std::int32_t first[3];
  double all = 1;
  for (int a = 0; a < 3; ++a) {
    first[a] = static_cast<std::int32_t>(lo[a]) & ~(kSurfaceBlock - 1);
    blocks.count_[a] = (static_cast<std::int64_t>(hi[a]) - first[a]) / kSurfaceBlock + 1;
    all *= static_cast<double>(blocks.count_[a]);
  }
  blocks.first_ = {first[0], first[1], first[2]};
  constexpr double kMaxBlocks = 1 << 28;
  if (all > kMaxBlocks)
    return Error{fmt::format("{}: the box of the grid has {:.0f} blocks of 8^3 voxels, expected at most {:.0f}", name, all, kMaxBlocks)};
  if (lo.x == hi.x || lo.y == hi.y || lo.z == hi.z)
    return Error{name + ": the grid has a single layer of voxels and no cells; a volume was expected"};
  blocks.read_sides(0, blocks.lower_);
  return blocks;
}

Index3 SurfaceBlocks::block_at(std::int64_t i, std::int64_t j, std::int64_t k) const {
  return {static_cast<std::int32_t>(first_.x + i * kSurfaceBlock), static_cast<std::int32_t>(first_.y + j * kSurfaceBlock),
          static_cast<std::int32_t>(first_.z + k * kSurfaceBlock)};
}

void SurfaceBlocks::read_sides(std::int64_t k, std::vector<char>& sides) const {
  sides.clear();
  for (std::int64_t j = 0; j <= count_[1]; ++j)
    for (std::int64_t i = 0; i <= count_[0]; ++i) {
      float value = 0;
      sides.push_back(!grid_->is_constant_block(block_at(i, j, k), value) ? kMixed : value >= level_ ? kAbove : kBelow);
    }
}

std::vector<Index3> SurfaceBlocks::next_layer() {
  const std::int64_t k = next_++;
  const auto across = static_cast<std::size_t>(count_[0] + 1);
  std::vector<Index3> blocks;
  read_sides(k + 1, upper_);
  for (std::int64_t j = 0; j < count_[1]; ++j)
    for (std::int64_t i = 0; i < count_[0]; ++i) {
      const std::size_t at = static_cast<std::size_t>(j) * across + static_cast<std::size_t>(i);
      bool same_side = lower_[at] != kMixed;
      for (const auto* sides : {&lower_, &upper_})
        for (const std::size_t neighbor : {at, at + 1, at + across, at + across + 1})
          same_side = same_side && (*sides)[neighbor] == lower_[at];
      if (!same_side) blocks.push_back(block_at(i, j, k));
    }
  std::swap(lower_, upper_);
  return blocks;
}

}  // namespace catena::mesh
