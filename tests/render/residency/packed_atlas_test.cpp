// SPDX-License-Identifier: MIT
#include "render/residency/packed_atlas.h"

#include <algorithm>

#include "tests/render/support/device_fixture.h"
#include "tests/render/support/image_fixture.h"

namespace catena::test::packed_atlas_test {

using namespace catena::render;

/// Values 0 except some voxels of 1; visible above one half.
CodeAppearance visible_above_half(const CodeScale& codes) {
  CodeAppearance looks;
  for (int c = 0; c < 256; ++c) {
    looks.is_invisible[std::size_t(c)] = codes.lo + c * codes.per_code <= 0.5;
    looks.appearance_id[std::size_t(c)] = looks.is_invisible[std::size_t(c)] ? 0 : std::uint16_t(c);
  }
  return looks;
}

class Atlas : public DeviceFixture {
 protected:
  std::uint64_t count_kept_bricks(const std::function<double(const Vec3&)>& f) {
    const auto grid = make_grid({64, 64, 64}, f);
    const BrickScan scan = scan_bricks(*grid, {0, 1}, false);
    const CodeScale codes(scan.range, false);
    const auto atlas = make_packed_atlas(*device_, *grid, scan, codes, visible_above_half(codes), 1 << 30);
    EXPECT_TRUE(atlas) << atlas.error().message;
    return atlas ? atlas->stored_count : 0;
  }
};

TEST_F(Atlas, KeepsTheVisibleBricks) {
  const auto one_at = [](int place) { return [place](const Vec3& p) { return p == Vec3(place) ? 1.0 : 0.0; }; };
  EXPECT_EQ(count_kept_bricks(one_at(20)), 1u);  // within the third brick of each axis
  EXPECT_EQ(count_kept_bricks(one_at(16)), 8u);  // on the common corner of eight bricks
  EXPECT_EQ(count_kept_bricks([](const Vec3&) { return 0.0; }), 0u);
  EXPECT_EQ(count_kept_bricks([](const Vec3&) { return 1.0; }), 0u) << "of one code: the map says it";
}

TEST_F(Atlas, KeepsTheNeighboursOfVisibleBricks) {
  // the invisible values vary
  EXPECT_EQ(count_kept_bricks([](const Vec3& p) { return p == Vec3(20) ? 1.0 : 0.004 * p.x; }), 27u);
}

TEST_F(Atlas, ScansOnlyTheGridsOwnVoxels) {
  // the size is not a multiple of 8
  const auto grid = make_grid({19, 9, 30}, [](const Vec3& p) { return 0.2 + 0.01 * p.x; });
  const BrickScan scan = scan_bricks(*grid, {0.3, 0.305}, true);
  EXPECT_EQ(scan.bricks, (std::array<std::int32_t, 3>{3, 1, 4}));
  EXPECT_FLOAT_EQ(scan.values[0].min, 0.2f);
  EXPECT_FLOAT_EQ(scan.values[0].max, 0.28f);
  EXPECT_FLOAT_EQ(scan.values[2].max, 0.38f);
  // includes all values of the cells that the range touches
  EXPECT_NEAR(scan.range.min, 0.3, 1e-6);
  EXPECT_NEAR(scan.range.max, 0.31, 1e-6);
}

TEST_F(Atlas, CoarseGradientsSufficeForSmoothFields) {
  const auto smooth = make_grid({40, 40, 40}, [](const Vec3& p) { return 0.5 + 0.5 * std::sin(0.2 * p.x) * std::sin(0.2 * p.y); });
  EXPECT_LT(scan_bricks(*smooth, {0, 1}, true).gradient_roughness, 0.01);
  std::uint32_t state = 1;
  const auto noise = make_grid({40, 40, 40}, [&](const Vec3&) {
    state = state * 1664525u + 1013904223u;
    return double(state >> 8) / (1 << 24);
  });
  EXPECT_GT(scan_bricks(*noise, {0, 1}, true).gradient_roughness, 0.5);
}

TEST(VoxelCodes, VoxelsOfInvalidCellsHaveNoCode) {
  const auto grid = make_grid(
      {6, 4, 4}, [](const Vec3& p) { return p.x == 3 ? std::nan("") : p.x; }, {}, [](const Vec3& p) { return p.x != 3; });
  EXPECT_TRUE(has_invalid_cells(*grid));
  VoxelBlock block;
  block.read(*grid, {0, 0, 0}, {6, 4, 4}, true);
  const CodeScale codes({0, 5}, true);
  std::vector<std::uint8_t> row(6);
  codes.encode(block, block.voxel_index(0, 1, 2), 6, row.data());
  EXPECT_EQ(row, (std::vector<std::uint8_t>{1, 52, 103, 0, 204, 255}));
}

TEST(VoxelCodes, CellsThatTouchTheActiveRangeKeepAllTheirVoxels) {
  // one row of steps, duplicated in y and z
  const std::vector<float> row{0, 0.1f, 0.4f, 0.6f, 0.9f, 1};
  const auto grid = make_grid({6, 2, 2}, [&](const Vec3& p) { return row[std::size_t(p.x)]; });
  VoxelBlock block;
  block.read(*grid, {0, 0, 0}, {6, 2, 2}, false);
  const auto widened = [&](ValueInterval active) {
    ValueInterval range = active;
    widen_to_cells(range, block, active);
    return range;
  };
  EXPECT_FLOAT_EQ(float(widened({0.45, 0.5}).min), 0.4f);
  EXPECT_FLOAT_EQ(float(widened({0.45, 0.5}).max), 0.6f);
  EXPECT_FLOAT_EQ(float(widened({0.05, 0.95}).min), 0);
  EXPECT_FLOAT_EQ(float(widened({0.05, 0.95}).max), 1);
}

}  // namespace catena::test::packed_atlas_test
