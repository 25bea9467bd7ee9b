// SPDX-License-Identifier: MIT
#include "render/residency/cell_map.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/render/support/device_fixture.h"

namespace catena::test::cell_map_test {

using namespace catena::render;

class CellMaps : public DeviceFixture {
 protected:
  ResidentGrid mirror_of(const field::ScalarGrid& grid, const ResidencyOptions& options) {
    auto mirror = make_resident_grid(*device_, grid, options);
    EXPECT_TRUE(mirror);
    return std::move(*mirror);
  }
};

struct Values {
  field::Index3 n;
  std::vector<float> values;
  std::vector<std::uint8_t> valid;
  std::shared_ptr<const field::ScalarGrid> grid() const { return field::make_scalar_grid("g", {}, n, values, valid); }
};

Values random_values(const field::Index3& n, unsigned seed, double masked) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  Values v;
  v.n = n;
  for (int i = 0; i < n.x * n.y * n.z; ++i) {
    v.values.push_back(uniform(random));
    if (masked > 0) v.valid.push_back(uniform(random) >= masked);
  }
  return v;
}

/// Bit of a cell, by index.
bool bit_of(const CellMap& map, const ResidentGrid& mirror, int x, int y, int z) {
  const int lx = x - mirror.origin.x, ly = y - mirror.origin.y, lz = z - mirror.origin.z;
  return map.texels[map.block_index(lx / 2, ly / 2, lz / 2)] >> ((lx & 1) + 2 * (ly & 1) + 4 * (lz & 1)) & 1;
}

/// Cells that contain the level, by the grid's own cells.
template <class Each>
void for_each_cell(const field::ScalarGrid& grid, const field::Index3& n, Each&& each) {
  std::vector<float> v(std::size_t(n.x) * n.y * n.z);
  std::vector<std::uint8_t> valid(v.size());
  grid.read_block({0, 0, 0}, n, v);
  grid.read_cell_validity({0, 0, 0}, n, valid);
  for (int z = 0; z + 1 < n.z; ++z)
    for (int y = 0; y + 1 < n.y; ++y)
      for (int x = 0; x + 1 < n.x; ++x) {
        float minimum = HUGE_VALF, maximum = -HUGE_VALF;
        for (int c = 0; c < 8; ++c) {
          const float value = v[(std::size_t(z + (c >> 2)) * n.y + y + (c >> 1 & 1)) * n.x + x + (c & 1)];
          minimum = std::min(minimum, value);
          maximum = std::max(maximum, value);
        }
        each(x, y, z, valid[(std::size_t(z) * n.y + y) * n.x + x] != 0, minimum, maximum);
      }
}

TEST_F(CellMaps, BitsMatchTheCellCorners) {
  for (const double masked : {0.0, 0.05}) {
    const Values values = random_values({29, 18, 41}, 3, masked);
    const auto grid = values.grid();
    for (const GridLayout layout : {GridLayout::dense, GridLayout::atlas}) {
      const ResidentGrid mirror = mirror_of(*grid, {true, layout});
      const float level = 0.12f;
      const CellMap map = make_cell_map(*grid, mirror, level);
      std::uint64_t cells = 0;
      for_each_cell(*grid, values.n, [&](int x, int y, int z, bool valid, float minimum, float maximum) {
        const bool holds = valid && minimum < level && maximum >= level;
        cells += holds;
        ASSERT_EQ(bit_of(map, mirror, x, y, z), holds) << x << " " << y << " " << z;
      });
      EXPECT_EQ(map.cell_count, cells);
      EXPECT_GT(cells, 1000u);
    }
  }
}

TEST_F(CellMaps, ALevelOnAVoxelCountsAsAbove) {
  std::vector<float> values;
  for (int i = 0; i < 1000; ++i) values.push_back(float(i % 10));
  const auto grid = field::make_scalar_grid("ramp", {}, {10, 10, 10}, values);
  const ResidentGrid mirror = mirror_of(*grid, {true, GridLayout::dense});
  const CellMap map = make_cell_map(*grid, mirror, 4.0f);
  for (int x = 0; x < 9; ++x) EXPECT_EQ(bit_of(map, mirror, x, 5, 5), x == 3) << x;
  EXPECT_EQ(map.lo.x, 0);
  EXPECT_EQ(map.hi.x, 4);
  EXPECT_EQ(map.hi.y, 9);
}

TEST_F(CellMaps, HalfFloatsAreTestedAsStored) {
  // half floats round by up to 2^-12: the stored texels decide
  const Values values = random_values({20, 20, 20}, 7, 0);
  const auto grid = values.grid();
  const ResidentGrid mirror = mirror_of(*grid, {false, GridLayout::dense});
  ASSERT_EQ(mirror.offset, 0);
  const float level = 0.0500183f;
  const CellMap map = make_cell_map(*grid, mirror, level), exact = make_cell_map(*grid, mirror_of(*grid, {true, GridLayout::dense}), level);
  const float spacing = 0.05f / 1024;
  std::uint64_t differ = 0;
  for_each_cell(*grid, values.n, [&](int x, int y, int z, bool, float minimum, float maximum) {
    const bool here = bit_of(map, mirror, x, y, z);
    if (minimum < level - spacing && maximum > level + spacing) {
      ASSERT_TRUE(here);
    }
    if (minimum > level + spacing || maximum < level - spacing) {
      ASSERT_FALSE(here);
    }
    differ += here != bit_of(exact, mirror, x, y, z);
  });
  EXPECT_LT(differ, 20u);
}

TEST_F(CellMaps, DistancesAreToTheNextBrickWithTheLevel) {
  std::vector<float> values(33 * 33 * 33);
  for (const int at : {5 + 33 * (6 + 33 * 30), 20 + 33 * (29 + 33 * 2)}) values[at] = 1;
  const auto grid = field::make_scalar_grid("dots", {}, {33, 33, 33}, values);
  const ResidentGrid mirror = mirror_of(*grid, {true, GridLayout::dense});
  const CellMap map = make_cell_map(*grid, mirror, 0.5f);
  EXPECT_EQ(map.cell_count, 16u);
  const auto holds = [&](int bx, int by, int bz) {
    for (int c = 0; c < 64; ++c) {
      const int x = 4 * bx + (c & 3), y = 4 * by + (c >> 2 & 3), z = 4 * bz + (c >> 4);
      if (bit_of(map, mirror, x, y, z)) return true;
    }
    return false;
  };
  std::vector<std::array<int, 3>> active;
  const int n = map.blocks[0] / 2;
  for (int i = 0; i < n * n * n; ++i)
    if (holds(i % n, i / n % n, i / n / n)) active.push_back({i % n, i / n % n, i / n / n});
  ASSERT_GE(active.size(), 2u);
  for (int z = 0; z < map.blocks[2]; ++z)
    for (int y = 0; y < map.blocks[1]; ++y)
      for (int x = 0; x < map.blocks[0]; ++x) {
        int nearest = 255;
        for (const auto& a : active)
          nearest = std::min(nearest, std::max({std::abs(x / 2 - a[0]), std::abs(y / 2 - a[1]), std::abs(z / 2 - a[2])}));
        ASSERT_EQ(map.texels[map.block_index(x, y, z)] >> 8, nearest);
      }
}

TEST_F(CellMaps, NoLevelsAndTooManyLevels) {
  const Values values = random_values({16, 16, 16}, 1, 0);
  const auto grid = values.grid();
  const ResidentGrid mirror = mirror_of(*grid, {true, GridLayout::dense});
  const CellMap none = make_cell_map(*grid, mirror, 2.0f);
  EXPECT_EQ(none.cell_count, 0u);
  EXPECT_EQ(none.lo, none.hi);
  const CellMap many = make_cell_map(*grid, mirror, 0.5f, 100);
  EXPECT_TRUE(many.texels.empty());
  EXPECT_EQ(many.hi, mirror.box_hi);
}

}  // namespace catena::test::cell_map_test
