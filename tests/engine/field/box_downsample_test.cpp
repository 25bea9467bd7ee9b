// SPDX-License-Identifier: MIT
#include "engine/field/derived/box_downsample.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/field/field_helpers.h"

namespace catena::field::box_downsample_test {

template <class F>
std::shared_ptr<const ScalarGrid> grid_of(const Index3& n, const F& f, const Mapping& mapping = {},
                                          const std::vector<std::uint8_t>& valid = {}) {
  return make_scalar_grid("g", mapping, n, test::values_of(n, f), valid);
}

CoarseGrid coarse_of(const ScalarGrid& grid, int factor) { return test::value_of(box_downsample(grid, factor)); }

TEST(BoxDownsample, ALinearFieldIsUnchangedUpToTheFaces) {
  const Mapping mapping = Mapping::from_linear({{0.5, 0.1, 0}, {0, 0.25, 0.05}, {0.02, 0, 1}}, {3, -2, 7});
  for (const Index3 n : {Index3{32, 32, 32}, Index3{21, 34, 17}}) {
    const auto grid = grid_of(
        n, [](int x, int y, int z) { return 0.5 * x - 0.25 * y + z; }, mapping);
    for (const int factor : {2, 4, 8}) {
      const CoarseGrid coarse = coarse_of(*grid, factor);
      Cursor fine_cursor, cursor;
      for (double u : {0.0, 0.03, 0.5, 0.71, 1.0})
        for (double v : {0.0, 0.2, 1.0})
          for (double w : {0.0, 0.9, 1.0}) {
            const Vec3 index = grid->index_box().lo + Vec3(u, v, w) * (grid->index_box().hi - grid->index_box().lo);
            const Vec3 world = mapping.world_from_index(index);
            const ScalarSample fine = grid->sample(world, fine_cursor), here = coarse.grid->sample(world, cursor);
            ASSERT_TRUE(here.inside) << "factor " << factor;
            ASSERT_NEAR(here.value, fine.value, 1e-4) << "factor " << factor << " at " << index.x << " " << index.y << " " << index.z;
          }
      // The box of the grid exceeds the domain by less than a voxel.
      for (int a = 0; a < 3; ++a) {
        EXPECT_GE(coarse.domain.lo[a], coarse.grid->index_box().lo[a]);
        EXPECT_LT(coarse.domain.lo[a], coarse.grid->index_box().lo[a] + 1);
        EXPECT_LE(coarse.domain.hi[a], coarse.grid->index_box().hi[a]);
        EXPECT_GT(coarse.domain.hi[a], coarse.grid->index_box().hi[a] - 1);
      }
    }
  }
}

TEST(BoxDownsample, AVoxelIsTheAverageOfItsBox) {
  const auto value = [](int x, int y, int z) { return std::sin(0.7 * x) + std::cos(1.3 * y * z); };
  const auto grid = grid_of({24, 24, 24}, value);
  for (const int factor : {2, 4, 8}) {
    const CoarseGrid coarse = coarse_of(*grid, factor);
    std::vector<float> one(1);
    for (const Index3 c : {Index3{0, 0, 0}, Index3{1, 2, 1}, Index3{24 / factor - 1, 0, 1}}) {
      double sum = 0;
      for (int k = 0; k < factor * factor * factor; ++k)
        sum += value(factor * c.x + k % factor, factor * c.y + k / factor % factor, factor * c.z + k / factor / factor);
      coarse.grid->read_block(c, {1, 1, 1}, one);
      EXPECT_NEAR(one[0], sum / (factor * factor * factor), 1e-5);
    }
  }
}

TEST(BoxDownsample, ASparseGridStaysSparse) {
  // A ball in an empty grid.
  const auto grid = grid_of({128, 128, 128}, [](int x, int y, int z) { return std::hypot(x - 64, y - 64, z - 64) < 12 ? 1.0 : 0.0; });
  const CoarseGrid coarse = coarse_of(*grid, 2);
  float value = -1;
  EXPECT_TRUE(coarse.grid->is_constant_block({0, 0, 0}, value));
  EXPECT_EQ(value, 0);
  int stored = 0;
  for (int z = 0; z < 64; z += 8)
    for (int y = 0; y < 64; y += 8)
      for (int x = 0; x < 64; x += 8) stored += !coarse.grid->is_constant_block({x, y, z}, value);
  EXPECT_GT(stored, 7);
  EXPECT_LE(stored, 27);
}

TEST(BoxDownsample, OnlyValidVoxelsAreAveraged) {
  // The left half is invalid, with meaningless values; a NaN is on the right.
  const Index3 n{16, 16, 16};
  const auto value = [](int x, int y, int z) { return x < 8 ? 1e6 : x == 12 && y == 4 && z == 4 ? NAN : 2.0; };
  const auto grid = grid_of(n, value, {}, test::values_of<std::uint8_t>(n, [](int x, int, int) { return x >= 8; }));
  const CoarseGrid coarse = coarse_of(*grid, 2);
  Cursor cursor;
  EXPECT_FALSE(coarse.grid->sample({3, 8, 8}, cursor).inside);
  EXPECT_TRUE(coarse.grid->sample({10, 10, 10}, cursor).inside);
  std::vector<float> values(1);
  for (int x = 4; x < 8; ++x)
    for (int y = 0; y < 8; ++y)
      for (int z = 0; z < 8; ++z) {
        coarse.grid->read_block({x, y, z}, {1, 1, 1}, values);
        ASSERT_FLOAT_EQ(values[0], 2) << x << " " << y << " " << z;
      }
}

}  // namespace catena::field::box_downsample_test
