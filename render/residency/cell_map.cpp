// SPDX-License-Identifier: MIT
#include "render/residency/cell_map.h"

#include <Imath/half.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "engine/base/threads.h"
#include "render/residency/brick_map.h"
#include "render/residency/cubic_cells.h"
#include "render/vk/commands.h"

namespace catena::render {
namespace {

constexpr int kCellBrick = 4, kBlocks = kBrickSize / 2;
constexpr std::size_t kVoxels = std::size_t(kPaddedBrickSize) * kPaddedBrickSize * kPaddedBrickSize;
constexpr std::size_t kCubicVoxels = std::size_t(kCubicSamples) * kCubicSamples * kCubicSamples;
constexpr float kCubicRounding = 1e-5f;  // share of the brick's range; exceeds the rounding error of the shader

/// Signs of the corners of a brick of 8^3 cells relative to the level, nine bits per row of voxels; `slack` widens the level to an
/// interval.
struct Rows {
  std::array<std::uint32_t, kPaddedBrickSize * kPaddedBrickSize> above{}, clearly_above{};

  void compare(const std::vector<float>& values, float level, float slack) {
    const float low = level - slack, high = level + slack;
    for (std::size_t row = 0; row < above.size(); ++row) {
      const float* v = &values[row * kPaddedBrickSize];
      std::uint32_t a = 0, c = 0;
      for (int x = 0; x < kPaddedBrickSize; ++x) {
        a |= std::uint32_t(v[x] >= low) << x;
        c |= std::uint32_t(v[x] >= high) << x;
      }
      above[row] = a;
      clearly_above[row] = c;
    }
  }
  /// Returns the cells of the row (y, z), eight bits, that have corners on both sides of the level.
  std::uint32_t crossed(int y, int z) const {
    std::uint32_t some = 0, all = ~0u;
    for (const int row :
         {z * kPaddedBrickSize + y, z * kPaddedBrickSize + y + 1, (z + 1) * kPaddedBrickSize + y, (z + 1) * kPaddedBrickSize + y + 1}) {
      some |= above[row] | above[row] >> 1;
      all &= clearly_above[row] & clearly_above[row] >> 1;
    }
    return some & ~all & 0xffu;
  }
};

class CellMapBuilder {
 public:
  CellMapBuilder(const field::ScalarGrid& grid, const ResidentGrid& resident, float level)
      : grid_(grid), resident_(resident), level_(level) {
    halves_ = resident.values.info().format == VK_FORMAT_R16_SFLOAT;
    if (halves_ && resident.offset != 0) slack_ = 1e-6f * (std::fabs(resident.offset) + std::fabs(resident.scale));
  }

  void build(CellMap& map) const {
    const auto [bx, by, bz] = resident_.bricks;
    parallel_for(std::size_t(by) * bz, 1, [&, bx = bx, by = by](std::size_t begin, std::size_t end) {
      std::vector<float> values(resident_.cubic ? kCubicVoxels : kVoxels);
      std::vector<std::uint8_t> valid(resident_.masked ? kVoxels : 0);
      for (std::size_t line = begin; line < end; ++line)
        for (int x = 0; x < bx; ++x) brick(map, {x, int(line % by), int(line / by)}, values, valid);
    });
  }

 private:
  void brick(CellMap& map, const field::Index3& at, std::vector<float>& values, std::vector<std::uint8_t>& valid) const {
    const BrickRange& range = resident_.brick_ranges[resident_.brick_index(at.x, at.y, at.z)];
    if (range.empty() || range.min - slack_ > level_ || range.max + slack_ < level_) return;
    const field::Index3 first{kBrickSize * at.x, kBrickSize * at.y, kBrickSize * at.z};
    const field::Index3 origin{resident_.origin.x + first.x, resident_.origin.y + first.y, resident_.origin.z + first.z};
    if (resident_.cubic)
      grid_.read_block({origin.x - 1, origin.y - 1, origin.z - 1}, {kCubicSamples, kCubicSamples, kCubicSamples}, values);
    else
      grid_.read_block(origin, {kPaddedBrickSize, kPaddedBrickSize, kPaddedBrickSize}, values);
    if (halves_)
      for (float& v : values)
        v = resident_.offset + resident_.scale * imath_half_to_float(imath_float_to_half((v - resident_.offset) / resident_.scale));
    if (!valid.empty()) grid_.read_cell_validity(origin, {kPaddedBrickSize, kPaddedBrickSize, kPaddedBrickSize}, valid);
    Rows rows;
    std::array<std::uint8_t, kBrickSize * kBrickSize> cubic_rows{};
    if (resident_.cubic)
      cubic_rows = find_cubic_cells(values, level_, slack_ + kCubicRounding * (range.max - range.min));
    else
      rows.compare(values, level_, slack_);
    // the brick's cells inside the domain
    std::array<int, 3> lo{}, hi{};
    for (int axis = 0; axis < 3; ++axis) {
      const int begin = axis == 0 ? first.x : axis == 1 ? first.y : first.z;
      lo[axis] = std::max(0, int(std::lround(resident_.box_lo[axis])) - begin);
      hi[axis] = std::min(kBrickSize, int(std::lround(resident_.box_hi[axis])) - begin);
    }
    const std::uint32_t in_x = hi[0] > lo[0] ? (0xffu >> (kBrickSize - hi[0])) & (0xffu << lo[0]) : 0u;
    for (int z = lo[2]; z < hi[2]; ++z)
      for (int y = lo[1]; y < hi[1]; ++y) {
        std::uint32_t cells = (resident_.cubic ? cubic_rows[y + kBrickSize * z] : rows.crossed(y, z)) & in_x;
        if (!valid.empty() && cells) cells &= valid_cells(values, valid, y, z);
        for (int x = 0; cells; ++x, cells >>= 2) {
          const std::size_t block = map.block_index(kBlocks * at.x + x, kBlocks * at.y + y / 2, kBlocks * at.z + z / 2);
          map.texels[block] = std::uint16_t(map.texels[block] | (cells & 3u) << (2 * (y & 1) + 4 * (z & 1)));
        }
      }
  }

  /// Returns the valid cells of the row (y, z), eight bits. A cell with a corner that is not finite is invalid; a cubic grid has finite
  /// ghosts at such corners, so that only the grid's own validity counts.
  std::uint32_t valid_cells(const std::vector<float>& values, const std::vector<std::uint8_t>& valid, int y, int z) const {
    std::uint32_t cells = 0;
    for (int x = 0; x < kBrickSize; ++x) {
      bool is_valid = valid[(std::size_t(z) * kPaddedBrickSize + y) * kPaddedBrickSize + x] != 0;
      for (int c = 0; c < 8 && is_valid && !resident_.cubic; ++c)
        is_valid =
            std::isfinite(values[(std::size_t(z + (c >> 2)) * kPaddedBrickSize + y + (c >> 1 & 1)) * kPaddedBrickSize + x + (c & 1)]);
      cells |= std::uint32_t(is_valid) << x;
    }
    return cells;
  }

  const field::ScalarGrid& grid_;
  const ResidentGrid& resident_;
  float level_, slack_ = 0;
  bool halves_ = false;
};

/// Adds the distances to active bricks, the number of cells, and the bounds of the active bricks.
void finish(CellMap& map, const ResidentGrid& resident) {
  std::array<std::int32_t, 3> bricks{};
  for (int axis = 0; axis < 3; ++axis) bricks[axis] = map.blocks[axis] / 2;
  const auto [bx, by, bz] = bricks;
  std::vector<std::uint8_t> active(std::size_t(bx) * by * bz);
  std::array<int, 3> min_block{bx, by, bz}, max_block{-1, -1, -1};
  for (std::size_t i = 0; i < active.size(); ++i) {
    const std::array<int, 3> at{int(i % bx), int(i / bx % by), int(i / bx / by)};
    int cells = 0;
    for (int c = 0; c < 8; ++c)
      cells += std::popcount(map.texels[map.block_index(2 * at[0] + (c & 1), 2 * at[1] + (c >> 1 & 1), 2 * at[2] + (c >> 2))]);
    if (!cells) continue;
    active[i] = 1;
    map.cell_count += std::uint64_t(cells);
    for (int axis = 0; axis < 3; ++axis) {
      min_block[axis] = std::min(min_block[axis], at[axis]);
      max_block[axis] = std::max(max_block[axis], at[axis]);
    }
  }
  const std::vector<std::uint8_t> distance = empty_distances(bricks, active);
  parallel_for(std::size_t(map.blocks[1]) * map.blocks[2], 64, [&, bx = bx, by = by](std::size_t begin, std::size_t end) {
    for (std::size_t line = begin; line < end; ++line) {
      const std::size_t y = line % map.blocks[1] / 2, z = line / map.blocks[1] / 2;
      const std::uint8_t* from = &distance[(z * by + y) * bx];
      std::uint16_t* texels = &map.texels[line * map.blocks[0]];
      for (int x = 0; x < map.blocks[0]; ++x) texels[x] = std::uint16_t(texels[x] | from[x / 2] << 8);
    }
  });
  if (map.cell_count == 0) return;
  for (int axis = 0; axis < 3; ++axis) {
    map.lo[axis] = std::max(resident.box_lo[axis], double(kCellBrick * min_block[axis]));
    map.hi[axis] = std::min(resident.box_hi[axis], double(kCellBrick * (max_block[axis] + 1)));
  }
}

}  // namespace

CellMap make_cell_map(const field::ScalarGrid& grid, const ResidentGrid& resident, float level, std::uint64_t max_texels) {
  CATENA_ASSERT(resident.is_drawable);
  CellMap map;
  std::uint64_t count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    map.blocks[axis] = kBlocks * resident.bricks[axis];
    count *= std::uint64_t(map.blocks[axis]);
  }
  map.lo = resident.box_lo;
  map.hi = resident.box_hi;
  if (count > max_texels) return map;
  map.texels.assign(count, 0);
  map.lo = map.hi = Vec3(0.0);
  CellMapBuilder(grid, resident, level).build(map);
  finish(map, resident);
  return map;
}

Result<vk::Image> upload_cell_map(vk::Device& device, const CellMap& map) {
  const vk::ImageInfo info = vk::volume_image_info(VK_FORMAT_R16_UINT, map.blocks[0], map.blocks[1], map.blocks[2]);
  CATENA_TRY(vk::Image image, vk::Image::create(device, info));
  const std::size_t plane = std::size_t(map.blocks[0]) * map.blocks[1];
  CATENA_CHECK(vk::upload_planes(device, image, 1, [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
    std::memcpy(out, map.texels.data() + first * plane, count * plane * sizeof(std::uint16_t));
  }));
  return image;
}

}  // namespace catena::render
