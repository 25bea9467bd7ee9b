// SPDX-License-Identifier: MIT
// The display range of grids: exact ends and counts for sampled, masked and constant grids, and the quantities scaled by it.
#include "engine/field/field_display_range.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/field/derived/magnitude.h"
#include "engine/io/volume/write_field.h"
#include "tests/engine/field/field_helpers.h"

namespace catena::field::field_display_range_test {

std::vector<float> waves(const Index3& n) {
  return test::values_of(
      n, [](int x, int y, int z) { return std::sin(0.1f * static_cast<float>(x + 2 * y)) + 0.01f * static_cast<float>(z); });
}

TEST(GridDisplayRange, CountsEveryOutlier) {
  const Index3 n{160, 120, 100};  // more blocks than are sampled
  std::vector<float> values = waves(n);
  const auto clean = make_scalar_grid("g", {}, n, values);
  EXPECT_FALSE(display_range(*clean).has_outliers());
  EXPECT_EQ(display_range(*clean).lo, clean->min_value());
  EXPECT_EQ(display_range(*clean).hi, clean->max_value());
  std::size_t missing = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (i % 160 < 40) values[i] = -9999, ++missing;
  for (const std::size_t i : {123456u, 234667u}) values[i] = 1e20f;
  const auto grid = make_scalar_grid("g", {}, n, values);
  const DisplayRange& range = display_range(*grid);
  EXPECT_EQ(range.below.count, missing);
  EXPECT_EQ(range.above.count, 2u);
  EXPECT_EQ(range.count, values.size());
  EXPECT_NEAR(range.lo, -1, 1e-2);
  EXPECT_NEAR(range.hi, 1 + 0.99, 1e-2);
  EXPECT_EQ(range.data_min, -9999);
  EXPECT_EQ(&range, &display_range(*grid->with_interpolation(Interpolation::nearest))) << "found once";
}

TEST(GridDisplayRange, HandlesMasksTilesVectorsAndFiles) {
  const Index3 n{32, 32, 32};
  std::vector<float> values = waves(n), vectors;
  std::vector<std::uint8_t> valid(values.size(), 1);
  values[777] = 1e20f, valid[777] = 0;
  EXPECT_FALSE(display_range(*make_scalar_grid("g", {}, n, values, valid)).has_outliers()) << "masked values do not count";
  // Constant blocks have no leaf nodes.
  for (std::size_t i = 0; i < values.size() / 2; ++i) values[i] = -9999;
  const auto half = make_scalar_grid("g", {}, n, values);
  EXPECT_EQ(display_range(*half).below.count, values.size() / 2);
  for (const float v : waves(n)) vectors.insert(vectors.end(), {v, 1, 0});
  vectors[3 * 5000] = 1e20f;
  const auto flow = make_vector_grid("v", {}, n, vectors);
  EXPECT_EQ(format_range(display_range(*flow)).substr(0, 5), "1 .. ");
  EXPECT_EQ(display_range(*flow).above.count, 1u);
  EXPECT_LT(compute_max_magnitude(*flow), 2);
  // The range of a file, as described by a reader process.
  const test::TemporaryFolder folder;
  for (const char* name : {"f.vdb", "f.nrrd", "f.vti"}) {
    test::value_of(write_field(folder / name, {half, nullptr}, "g", {}));
    const auto grids = test::value_of(describe_grids(folder / name));
    EXPECT_EQ(format_range(grids.front().display_range), format_range(display_range(*half))) << name;
  }
}

TEST(GridDisplayRange, OutliersDoNotInfluenceTheMaximumGradient) {
  const Index3 n{24, 24, 24};
  std::vector<float> values = waves(n);
  const double clean = compute_max_gradient(*make_scalar_grid("g", {}, n, values));
  for (const float outlier : {1e20f, -1e6f}) {
    values[5000] = outlier;
    EXPECT_NEAR(compute_max_gradient(*make_scalar_grid("g", {}, n, values)), clean, 0.05 * clean);
  }
}

}  // namespace catena::field::field_display_range_test
