// SPDX-License-Identifier: MIT
#include "engine/field/derived/magnitude.h"

#include <gtest/gtest.h>

#include <limits>

#include "engine/base/memory_limit.h"
#include "engine/field/analytic/analytic.h"
#include "tests/engine/field/field_helpers.h"
#include "tests/support/results.h"

namespace catena::field::magnitude_test {

TEST(Magnitude, MaximaOfFormulasAreOverTheirBox) {
  EXPECT_DOUBLE_EQ(compute_max_magnitude(*make_analytic("circle")->vector), std::sqrt(8.0));
  EXPECT_DOUBLE_EQ(compute_max_magnitude(*make_analytic("uniform", {.scale = 3, .part = {}})->vector), 3);
  EXPECT_DOUBLE_EQ(compute_max_gradient(*make_analytic("linear")->scalar), std::sqrt(3.0));
  EXPECT_EQ(compute_max_gradient(*make_analytic("constant")->scalar), 0);
  for (const double scale : {1e-300, 1e300}) {
    EXPECT_NEAR(compute_max_magnitude(*make_analytic("circle", {.scale = scale, .part = {}})->vector) / scale, std::sqrt(8.0), 1e-14);
    EXPECT_NEAR(compute_max_gradient(*make_analytic("linear", {.scale = scale, .part = {}})->scalar) / scale, std::sqrt(3.0), 1e-14);
  }
}

TEST(Magnitude, TheMaximumGradientOfAGridIsThatOfItsCells) {
  for (const Mapping& mapping : test::mappings()) {
    const test::Block block = test::random_block({6, 5, 4}, 3);
    const auto grid = make_scalar_grid("g", mapping, block.size, block.values);
    double truth = 0;
    for (int z = 0; z < 3; ++z)
      for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x) {
          // Central differences over one voxel equal the trilinear gradient at the center.
          const Vec3 c(x + 0.5, y + 0.5, z + 0.5);
          Vec3 g;
          for (int a = 0; a < 3; ++a) g[a] = 2 * (block.trilinear(c + test::along(a, 0.25)) - block.trilinear(c - test::along(a, 0.25)));
          truth = std::max(truth, norm(mapping.world_from_index_gradient(g)));
        }
    EXPECT_NEAR(compute_max_gradient(*grid), truth, 1e-5 * truth);
  }
}

TEST(Magnitude, SkipsNonFiniteValues) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> values{0, 1, 2, nan, 4, 9, 0, 1, 2, nan, 4, 9, 0, 1, 2, nan, 4, 9, 0, 1, 2, nan, 4, 9};
  const auto grid = make_scalar_grid("g", Mapping{}, {6, 2, 2}, values);
  EXPECT_DOUBLE_EQ(compute_max_gradient(*grid), 5);
  std::vector<float> xyz;
  for (const float v : values) xyz.insert(xyz.end(), {v, 0, 0});
  EXPECT_DOUBLE_EQ(compute_max_magnitude(*make_vector_grid("v", Mapping{}, {6, 2, 2}, xyz)), 9);
  EXPECT_EQ(compute_max_gradient(*make_scalar_grid("g", Mapping{}, {3, 3, 3}, std::vector<float>(27, 4.0F))), 0) << "equal values";
}

TEST(Magnitude, TheGridHasTheLengthAtEachVoxel) {
  const std::vector<float> xyz{3, 4, 0, 0, 0, 2, 1, 2, 2, 0, -5, 12, 0, 0, 0, 6, 8, 0, 1, 0, 0, 0, 1, 0};
  const auto made = test::value_of(make_magnitude_grid(*make_vector_grid("v", Mapping{}, {2, 2, 2}, xyz), "it"));
  std::vector<float> values(8);
  made->read_block({0, 0, 0}, {2, 2, 2}, values);
  EXPECT_EQ(values, (std::vector<float>{5, 2, 3, 13, 0, 10, 1, 1}));
}

// A magnitude beyond the range of floats must be an error, not a failed assertion.
TEST(Magnitude, AMagnitudeBeyondFloatsIsAnError) {
  const std::vector<float> xyz(24, 3e38F);
  EXPECT_EQ(test::message_of(make_magnitude_grid(*make_vector_grid("v", Mapping{}, {2, 2, 2}, xyz), "the magnitude of \"v\"")),
            "the magnitude of \"v\" has no finite value in any active voxel; magnitudes that fit into 32-bit floats were expected");
}

TEST(Magnitude, TheGridsMemoryIsChecked) {
  const auto grid = make_vector_grid("v", Mapping{}, {64, 64, 64}, std::vector<float>(3 * 64 * 64 * 64, 1.0F));
  set_memory_limit(900000);
  const auto made = make_magnitude_grid(*grid, "it");
  set_memory_limit(std::nullopt);
  EXPECT_TRUE(test::fails(made, "it needs 2 MB of memory, expected at most 0 MB"));
}

}  // namespace catena::field::magnitude_test
