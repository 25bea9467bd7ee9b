// SPDX-License-Identifier: MIT
#include "render/residency/brick_map.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/render/support/device_fixture.h"

namespace catena::test::brick_map_test {

using namespace catena::render;

TEST(BrickMap, DistancesMatchASearch) {
  std::mt19937 random(5);
  for (const int density : {0, 1, 3, 100}) {
    const std::array<std::int32_t, 3> n{9, 7, 11};
    std::vector<std::uint8_t> active(9 * 7 * 11);
    for (auto& a : active) a = int(random() % 200) < density;
    const auto distance = empty_distances(n, active);
    for (int i = 0; i < int(active.size()); ++i) {
      int nearest = 255;
      for (int j = 0; j < int(active.size()); ++j)
        if (active[j])
          nearest = std::min(nearest, std::max({std::abs(i % 9 - j % 9), std::abs(i / 9 % 7 - j / 9 % 7), std::abs(i / 63 - j / 63)}));
      ASSERT_EQ(distance[i], nearest);
    }
  }
}

class GridResidency : public DeviceFixture {};

std::shared_ptr<const field::ScalarGrid> grid_of(int n, const std::function<float(int, int, int)>& f) {
  std::vector<float> values;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) values.push_back(f(x, y, z));
  return field::make_scalar_grid("g", {}, {n, n, n}, values);
}

TEST_F(GridResidency, RangesCoverTheCornersOfABricksCells) {
  const auto grid = grid_of(21, [](int x, int y, int z) { return float(x + 100 * y + 10000 * z); });
  for (const GridLayout layout : {GridLayout::dense, GridLayout::atlas}) {
    const auto mirror = make_resident_grid(*device_, *grid, {true, layout});
    ASSERT_TRUE(mirror);
    ASSERT_EQ(mirror->bricks, (std::array<std::int32_t, 3>{3, 3, 3}));
    for (int z = 0; z < 3; ++z)
      for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x) {
          const BrickRange& r = mirror->brick_ranges[mirror->brick_index(x, y, z)];
          const auto end = [](int b) { return std::min(20, 8 * b + 8); };
          EXPECT_EQ(r.min, float(8 * x + 800 * y + 80000 * z));
          EXPECT_EQ(r.max, float(end(x) + 100 * end(y) + 10000 * end(z)));
        }
  }
}

TEST_F(GridResidency, DenseGridsStayDense) {
  const auto grid = grid_of(72, [](int x, int y, int z) { return float(x * y + z + 1); });
  const auto mirror = make_resident_grid(*device_, *grid, {});
  ASSERT_TRUE(mirror);
  EXPECT_FALSE(mirror->atlas);
  EXPECT_EQ(mirror->values.info().extent.width, 72u);
  EXPECT_EQ(mirror->values.info().format, VK_FORMAT_R16_SFLOAT);
}

TEST_F(GridResidency, ThinGridsAreNotDrawable) {
  const auto grid = field::make_scalar_grid("thin", {}, {5, 5, 1}, std::vector<float>(25, 1.0f));
  const auto mirror = make_resident_grid(*device_, *grid, {});
  ASSERT_TRUE(mirror);
  EXPECT_FALSE(mirror->is_drawable);
}

TEST_F(GridResidency, ActiveBricksAreTheRequestedOnes) {
  const auto grid = grid_of(33, [](int x, int, int) { return float(x); });
  const auto mirror = make_resident_grid(*device_, *grid, {true, GridLayout::dense});
  ASSERT_TRUE(mirror);
  const auto map = make_brick_map(*device_, *mirror, [](const BrickRange& r) { return r.max > 25; });
  ASSERT_TRUE(map);
  EXPECT_EQ(map->total_count, 64u);
  EXPECT_EQ(map->active_count, 16u);
}

}  // namespace catena::test::brick_map_test
