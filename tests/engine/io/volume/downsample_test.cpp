// SPDX-License-Identifier: MIT
#include "engine/io/volume/downsample.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/field/field_helpers.h"

namespace catena::field::downsample_test {

AnyField at(const AnyField& field, int level) { return test::value_of(downsample_to_level("f.vdb", field, level)); }

AnyField scalar_of(const Index3& n, const Mapping& mapping, const std::function<double(const Vec3&)>& f,
                   const std::vector<std::uint8_t>& valid = {}) {
  return {make_scalar_grid("g", mapping, n, test::values_of(n, [&](int x, int y, int z) { return f(Vec3(x, y, z)); }), valid), nullptr};
}

TEST(Downsample, ALinearFieldIsUnchanged) {
  for (const Mapping& mapping : test::mappings())
    for (int level = 1; level <= kMaxLevels; ++level) {
      const AnyField fine = scalar_of({26, 17, 9}, mapping, [](const Vec3& p) { return 0.5 * p.x - 0.25 * p.y + p.z; });
      const AnyField coarse = at(fine, level);
      const int f = 1 << level;
      const Vec3 last = coarse.scalar->mapping().world_from_index(coarse.scalar->index_box().hi);
      const Vec3 there(25 / f * f, 16 / f * f, 8 / f * f);
      EXPECT_LT(norm(last - mapping.world_from_index(there)), 1e-9);
      test::Random random(7);
      Cursor a, b;
      for (int k = 0; k < 200; ++k) {
        const Vec3 p = mapping.world_from_index(random.in_box(Vec3(0.0), there));
        const ScalarSample was = fine.scalar->sample(p, a), is = coarse.scalar->sample(p, b);
        ASSERT_TRUE(is.inside);
        ASSERT_NEAR(is.value, was.value, 1e-5);
      }
    }
}

TEST(Downsample, ANodeIsTheTentFilterOverPairsWithValues) {
  const test::Block block = test::random_block({9, 9, 9}, 5);
  std::vector<std::uint8_t> valid(block.values.size(), 1);
  valid[(4 * 9 + 4) * 9 + 5] = 0;
  const AnyField coarse = at({make_scalar_grid("g", {}, block.size, block.values, valid), nullptr}, 1);
  std::vector<float> got(125);
  coarse.scalar->grid()->read_block({0, 0, 0}, {5, 5, 5}, got);
  const auto node = [&](int x, int y, int z) { return got[static_cast<std::size_t>((z * 5 + y) * 5 + x)]; };
  const auto tent = [&](int x, int y, int z) {  // by definition: weights 1 2 1 along each axis, divided by 64
    double sum = 0;
    for (int k = -1; k < 2; ++k)
      for (int j = -1; j < 2; ++j)
        for (int i = -1; i < 2; ++i) sum += (i ? 1 : 2) * (j ? 1 : 2) * (k ? 1 : 2) * block.at(2 * x + i, 2 * y + j, 2 * z + k) / 64.0;
    return sum;
  };
  EXPECT_NEAR(node(1, 1, 1), tent(1, 1, 1), 1e-6);
  EXPECT_NEAR(node(1, 3, 2), tent(1, 3, 2), 1e-6);
  // Next to the hole: without the hole and its opposite node.
  const double pair = 2 * 2 * (block.at(5, 4, 4) + block.at(3, 4, 4));
  EXPECT_NEAR(node(2, 2, 2), (64 * tent(2, 2, 2) - pair) / (64 - 8), 1e-6);
  EXPECT_FLOAT_EQ(node(0, 0, 4), static_cast<float>(block.at(0, 0, 8)));  // a corner keeps its value
}

TEST(Downsample, HolesStayHoles) {
  const Index3 n{17, 17, 17};
  const auto valid = test::values_of<std::uint8_t>(n, [](int x, int, int) { return x < 12; });
  const AnyField coarse = at(scalar_of(
                                 n, {}, [](const Vec3& p) { return p.x > 11 ? 1e9 : p.x; }, valid),
                             1);
  Cursor cursor;
  for (double x = 0; x < 10; x += 0.5) {
    const ScalarSample s = coarse.scalar->sample({x, 8, 8}, cursor);
    ASSERT_TRUE(s.inside) << x;
    ASSERT_NEAR(s.value, x, 1e-5) << x;  // no influence of the hole's values
  }
  EXPECT_FALSE(coarse.scalar->sample({13, 8, 8}, cursor).inside);
}

TEST(Downsample, VectorsAndLabelsAreSubsampled) {
  const test::Block block = test::random_block({12, 9, 27}, 9);  // 9 x 9 x 12 vectors
  std::vector<float> xyz = block.values;
  const AnyField vectors = at({nullptr, make_vector_grid("v", {}, {12, 9, 9}, xyz)}, 2);
  std::vector<float> got(3 * 3 * 3 * 3);
  vectors.vector->grid()->read_block({0, 0, 0}, {3, 3, 3}, got);
  for (int z = 0; z < 3; ++z)
    for (int x = 0; x < 3; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_EQ(got[3 * static_cast<std::size_t>((z * 3 + 1) * 3 + x) + c],
                  xyz[3 * static_cast<std::size_t>((4 * z * 9 + 4) * 12 + 4 * x) + c]);
  const AnyField all = scalar_of({9, 9, 9}, {}, [](const Vec3& p) { return std::fmod(7 * p.x + 3 * p.y + p.z, 5.0); });
  const AnyField labels = at({all.scalar->grid()->with_interpolation(Interpolation::nearest), nullptr}, 1);
  EXPECT_EQ(labels.scalar->interpolation(), Interpolation::nearest);
  Cursor cursor;
  EXPECT_EQ(labels.scalar->sample({2, 4, 6}, cursor).value, std::fmod(7 * 2 + 3 * 4 + 6, 5.0));
}

TEST(Downsample, SingleLayersAreKept) {
  for (const int layers : {1, 2}) {
    const AnyField coarse = at(scalar_of({9, 9, layers}, {}, [](const Vec3& p) { return p.x + p.y; }), 1);
    EXPECT_EQ(coarse.scalar->index_box().hi.z - coarse.scalar->index_box().lo.z, layers - 1);
    EXPECT_EQ(coarse.scalar->index_box().hi.x - coarse.scalar->index_box().lo.x, 4);
  }
}

TEST(Downsample, ALinearFieldWithHolesIsUnchanged) {
  test::Random random(3);
  std::vector<std::uint8_t> valid;
  for (int k = 0; k < 17 * 17 * 17; ++k) valid.push_back(random.uniform(0, 1) > 0.1);
  const AnyField coarse = at(scalar_of(
                                 {17, 17, 17}, {}, [](const Vec3& p) { return 2 * p.x - p.y + 0.5 * p.z; }, valid),
                             2);
  std::vector<float> got(125);
  coarse.scalar->grid()->read_block({0, 0, 0}, {5, 5, 5}, got);
  for (int z = 0; z < 5; ++z)
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 5; ++x)
        if (valid[static_cast<std::size_t>((4 * z * 17 + 4 * y) * 17 + 4 * x)] != 0) {
          EXPECT_NEAR(got[static_cast<std::size_t>((z * 5 + y) * 5 + x)], 4 * (2 * x - y + 0.5 * z), 1e-4);
        }
}

TEST(Downsample, ReportsTheDifference) {
  // At spacing 2 h the linear interpolant of sin(w x) differs by at most (2 h w)^2 / 8.
  const double w = 0.2;
  const AnyField fine = scalar_of({65, 5, 5}, {}, [&](const Vec3& p) { return std::sin(w * p.x); });
  const AnyField coarse = at(fine, 1);
  const GridDifference d = compute_difference(*fine.scalar->grid(), *coarse.scalar->grid());
  EXPECT_LT(d.max, 4 * w * w / 8 + w * w / 4 + 1e-4);  // plus the error of the tent filter
  EXPECT_GT(d.max, 0.5 * (4 * w * w / 8));
  ASSERT_EQ(coarse.notes.size(), 1u);
  EXPECT_TRUE(test::has(coarse.notes[0], "33 x 3 x 3 of 65 x 5 x 5 voxels"));
}

TEST(Downsample, ShortAxesAreRefused) {
  const auto refused = downsample_to_level("f.vdb", scalar_of({40, 8, 40}, {}, [](const Vec3& p) { return p.x; }), 3);
  EXPECT_EQ(test::message_of(refused), "f.vdb: 8 voxels along y are too few for level of detail 3; more than 8 were expected");
}

}  // namespace catena::field::downsample_test
