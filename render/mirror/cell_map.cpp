#include "render/mirror/cell_map.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/base/parallel_for.h"
#include "render/mirror/brick_distances.h"
#include "render/mirror/half.h"

namespace catena::render {
namespace {

constexpr int kApron = kBrick + 1;
constexpr std::size_t kVoxels = std::size_t(kApron) * kApron * kApron;

/// Where the corners of a brick of 8^3 cells lie, nine bits a row of voxels; `slack` widens the level.
struct Rows {
  std::array<std::uint32_t, kApron * kApron> above{}, clearly_above{};

  void compare(const std::vector<float>& values, float level, float slack) {
    const float low = level - slack, high = level + slack;
    for (std::size_t row = 0; row < above.size(); ++row) {
      const float* v = &values[row * kApron];
      std::uint32_t a = 0, c = 0;
      for (int x = 0; x < kApron; ++x) {
        a |= std::uint32_t(v[x] >= low) << x;
        c |= std::uint32_t(v[x] >= high) << x;
      }
      above[row] = a;
      clearly_above[row] = c;
    }
  }
  /// Eight bits: the cells of the row at (y, z) with corners on both sides.
  std::uint32_t crossed(int y, int z) const {
    std::uint32_t some = 0, all = ~0u;
    for (const int row : {z * kApron + y, z * kApron + y + 1, (z + 1) * kApron + y, (z + 1) * kApron + y + 1}) {
      some |= above[row] | above[row] >> 1;
      all &= clearly_above[row] & clearly_above[row] >> 1;
    }
    return some & ~all & 0xffu;
  }
};

class Builder {
 public:
  Builder(const field::ScalarGrid& grid, const GridMirror& mirror, float level) : grid_(grid), mirror_(mirror), level_(level) {
    halves_ = mirror.values.info().format == VK_FORMAT_R16_SFLOAT;
    if (halves_ && mirror.offset != 0) slack_ = 1e-6f * (std::fabs(mirror.offset) + std::fabs(mirror.scale));
  }

  void build(CellMap& map) const {
    const auto [bx, by, bz] = mirror_.bricks;
    parallel_for(std::size_t(by) * bz, 1, [&, bx = bx, by = by](std::size_t begin, std::size_t end) {
      std::vector<float> values(kVoxels);
      std::vector<std::uint8_t> valid(mirror_.masked ? kVoxels : 0);
      for (std::size_t line = begin; line < end; ++line)
        for (int x = 0; x < bx; ++x) brick(map, {x, int(line % by), int(line / by)}, values, valid);
    });
  }

 private:
  void brick(CellMap& map, const field::Index3& at, std::vector<float>& values, std::vector<std::uint8_t>& valid) const {
    const BrickRange& range = mirror_.ranges[mirror_.brick_index(at.x, at.y, at.z)];
    if (range.empty() || range.least - slack_ > level_ || range.greatest + slack_ < level_) return;
    const field::Index3 first{kBrick * at.x, kBrick * at.y, kBrick * at.z};
    const field::Index3 origin{mirror_.origin.x + first.x, mirror_.origin.y + first.y, mirror_.origin.z + first.z};
    grid_.read_block(origin, {kApron, kApron, kApron}, values);
    if (halves_)
      for (float& v : values) v = mirror_.offset + mirror_.scale * float_from_half(half_from_float((v - mirror_.offset) / mirror_.scale));
    if (!valid.empty()) grid_.read_cell_valid(origin, {kApron, kApron, kApron}, valid);
    Rows rows;
    rows.compare(values, level_, slack_);
    // the domain's cells of this brick
    std::array<int, 3> lo{}, hi{};
    for (int axis = 0; axis < 3; ++axis) {
      const int begin = axis == 0 ? first.x : axis == 1 ? first.y : first.z;
      lo[axis] = std::max(0, int(std::lround(mirror_.box_lo[axis])) - begin);
      hi[axis] = std::min(kBrick, int(std::lround(mirror_.box_hi[axis])) - begin);
    }
    const std::uint32_t in_x = hi[0] > lo[0] ? (0xffu >> (kBrick - hi[0])) & (0xffu << lo[0]) : 0u;
    for (int z = lo[2]; z < hi[2]; ++z)
      for (int y = lo[1]; y < hi[1]; ++y) {
        std::uint32_t cells = rows.crossed(y, z) & in_x;
        if (!valid.empty() && cells) cells &= valid_cells(values, valid, y, z);
        for (int half = 0; half < 2; ++half) {
          const std::size_t word = map.word_index(2 * at.x + half, 2 * at.y + y / kCellBrick, 2 * at.z + z / kCellBrick) + 1 + z % kCellBrick / 2;
          map.words[word] |= (cells >> (kCellBrick * half) & 0xfu) << (kCellBrick * (y % kCellBrick) + 16 * (z % 2));
        }
      }
  }

  static std::uint32_t valid_cells(const std::vector<float>& values, const std::vector<std::uint8_t>& valid, int y, int z) {
    std::uint32_t cells = 0;
    for (int x = 0; x < kBrick; ++x) {
      bool is_valid = valid[(std::size_t(z) * kApron + y) * kApron + x] != 0;
      for (int c = 0; c < 8 && is_valid; ++c)
        is_valid = std::isfinite(values[(std::size_t(z + (c >> 2)) * kApron + y + (c >> 1 & 1)) * kApron + x + (c & 1)]);
      cells |= std::uint32_t(is_valid) << x;
    }
    return cells;
  }

  const field::ScalarGrid& grid_;
  const GridMirror& mirror_;
  float level_, slack_ = 0;
  bool halves_ = false;
};

/// Distances, the number of cells and what encloses their bricks.
void finish(CellMap& map, const GridMirror& mirror) {
  const auto [bx, by, bz] = map.bricks;
  std::vector<std::uint8_t> active((map.words.size() - 3) / 3);
  std::array<int, 3> least{bx, by, bz}, most{-1, -1, -1};
  for (std::size_t i = 0; i < active.size(); ++i) {
    const std::uint32_t low = map.words[3 + 3 * i + 1], high = map.words[3 + 3 * i + 2];
    active[i] = (low | high) != 0;
    if (!active[i]) continue;
    map.cells += std::uint64_t(std::popcount(low)) + std::uint64_t(std::popcount(high));
    const std::array<int, 3> at{int(i % bx), int(i / bx % by), int(i / bx / by)};
    for (int axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], at[axis]);
      most[axis] = std::max(most[axis], at[axis]);
    }
  }
  const std::vector<std::uint8_t> distance = brick_distances(map.bricks, active);
  for (std::size_t i = 0; i < active.size(); ++i) map.words[3 + 3 * i] = distance[i];
  if (map.cells == 0) return;
  for (int axis = 0; axis < 3; ++axis) {
    map.lo[axis] = std::max(mirror.box_lo[axis], double(kCellBrick * least[axis]));
    map.hi[axis] = std::min(mirror.box_hi[axis], double(kCellBrick * (most[axis] + 1)));
  }
}

}  // namespace

CellMap make_cell_map(const field::ScalarGrid& grid, const GridMirror& mirror, float level, std::uint64_t most_bytes) {
  CATENA_ASSERT(mirror.drawable);
  CellMap map;
  std::size_t count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    map.bricks[axis] = kBrick / kCellBrick * mirror.bricks[axis];
    count *= std::size_t(map.bricks[axis]);
  }
  map.lo = mirror.box_lo;
  map.hi = mirror.box_hi;
  if ((3 + 3 * count) * sizeof(std::uint32_t) > most_bytes) return map;
  map.words.assign(3 + 3 * count, 0);
  for (int axis = 0; axis < 3; ++axis) map.words[axis] = std::uint32_t(map.bricks[axis]);
  map.lo = map.hi = Vec3(0.0);
  Builder(grid, mirror, level).build(map);
  finish(map, mirror);
  return map;
}

}  // namespace catena::render
