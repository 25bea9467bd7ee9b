// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <limits>

#include "engine/field/analytic/analytic.h"
#include "tests/engine/field/field_helpers.h"

namespace catena::field {
namespace grid_vector_test {

using test::Block;
using test::Random;

TEST(VectorGrid, EqualsTheTrilinearFormulaInEachComponent) {
  const Index3 size{12, 17, 10};
  const std::array<Block, 3> parts{test::random_block(size, 1), test::random_block(size, 2), test::random_block(size, 3)};
  std::vector<float> xyz;
  for (std::size_t n = 0; n < parts[0].values.size(); ++n)
    for (const Block& part : parts) xyz.push_back(part.values[n]);
  for (const Mapping& mapping : test::mappings()) {
    const auto grid = make_vector_grid("v", mapping, size, xyz);
    Random random(4);
    Cursor cursor;
    for (int trial = 0; trial < 2000; ++trial) {
      const Vec3 index = random.in_box(Vec3(0.0), Vec3(11, 16, 9));
      const VectorSample s = grid->sample(mapping.world_from_index(index), cursor);
      ASSERT_TRUE(s.inside);
      for (int a = 0; a < 3; ++a) ASSERT_NEAR(s.value[a], parts[a].trilinear(index), 1e-12 * (1 + norm(mapping.origin)));
    }
  }
  // Reading as a block.
  const auto grid = make_vector_grid("v", {}, size, xyz);
  std::vector<float> out(xyz.size());
  grid->read_block({0, 0, 0}, size, out);
  EXPECT_EQ(out, xyz);
}

TEST(VectorGrid, HelixIsExactBecauseItIsLinear) {
  const auto grid = sample_on_grid(*make_analytic("helix").value().vector, 65, -2, 2);
  Cursor cursor;
  Random random(5);
  for (int trial = 0; trial < 1000; ++trial) {
    const Vec3 p = random.in_box(Vec3(-2.0), Vec3(2.0));
    ASSERT_NEAR(norm(grid->sample(p, cursor).value - Vec3(-2 * p.y, 2 * p.x, 0.5)), 0, 1e-6);
  }
  EXPECT_EQ(grid->name(), "helix");
  EXPECT_NEAR(grid->stats().max, std::sqrt(32.25), 1e-6);
}

TEST(VectorGrid, LineFieldsSurviveSignFlips) {
  const auto unit = Vec3(0.6, 0.8, 0);
  std::vector<float> xyz;
  Random random(6);
  for (int n = 0; n < 5 * 5 * 5; ++n) {
    const double sign = random.uniform(-1, 1) < 0 ? -1 : 1;
    for (int a = 0; a < 3; ++a) xyz.push_back(static_cast<float>(sign * unit[a]));
  }
  const auto grid = make_vector_grid("fibre", {}, {5, 5, 5}, xyz);
  Cursor cursor;
  double naive = 1;
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 p = random.in_box(Vec3(0.0), Vec3(4.0));
    const LineSample line = grid->sample_line(p, cursor);
    ASSERT_NEAR(std::fabs(dot(line.axis, unit)), 1, 1e-14);
    ASSERT_NEAR(line.speed, 1, 1e-7);
    ASSERT_NEAR(line.coherence, 1, 1e-7);  // half the digits, where two eigenvalues vanish
    naive = std::min(naive, norm(grid->sample(p, cursor).value));
  }
  EXPECT_LT(naive, 0.5);
}

TEST(VectorGrid, MaskBoundsTheFlow) {
  const std::vector<float> xyz(3 * 64, 1.f);
  std::vector<std::uint8_t> valid(64, 1);
  valid[63] = 0;
  const auto grid = make_vector_grid("v", {}, {4, 4, 4}, xyz, valid);
  Cursor cursor;
  EXPECT_TRUE(grid->has_mask());
  EXPECT_TRUE(grid->sample(Vec3(1.5), cursor).inside);
  EXPECT_FALSE(grid->sample(Vec3(2.5), cursor).inside);
  EXPECT_TRUE(grid->sample(Vec3(1.5, 2.5, 2.5), cursor).inside);
}

TEST(VectorGrid, ReportsWhyAPositionIsOutside) {
  std::vector<float> xyz(3 * 64, 1.f);
  std::vector<std::uint8_t> valid(64, 1);
  valid[63] = 0;
  xyz[0] = std::nanf("");
  const auto grid = make_vector_grid("v", {}, {4, 4, 4}, xyz, valid);
  Cursor cursor;
  EXPECT_EQ(grid->status_outside(Vec3(1.5), cursor), SampleStatus::ok);
  EXPECT_EQ(grid->status_outside(Vec3(2.5), cursor), SampleStatus::masked);
  EXPECT_EQ(grid->status_outside(Vec3(0.5), cursor), SampleStatus::not_finite);
  EXPECT_EQ(grid->status_outside(Vec3(1.5, 1.5, 3.1), cursor), SampleStatus::outside_box);
  EXPECT_EQ(grid->status_outside(Vec3(std::nan("")), cursor), SampleStatus::not_finite);
}

TEST(VectorGrid, FarAndNonFinitePointsAreOutside) {
  const std::vector<float> xyz(3 * 27, 1.f);
  const auto grid = make_vector_grid("v", {}, {3, 3, 3}, xyz);
  Cursor cursor;
  for (const double bad : {1e300, -1e300, std::numeric_limits<double>::infinity(), std::nan("")}) {
    const VectorSample s = grid->sample(Vec3(bad, 1, 1), cursor);
    EXPECT_FALSE(s.inside);
    EXPECT_TRUE(is_finite(s.value));
  }
}

TEST(VectorGrid, SamplingMasksNodesOutsideTheField) {
  const auto fibre = make_analytic("left-ventricle", {1, Vec3(1, 0, 0), "fibre"}).value().vector;
  const auto grid = sample_on_grid(*fibre, 41, -2, 2);
  EXPECT_TRUE(grid->has_mask());
  Cursor cursor;
  EXPECT_FALSE(grid->sample(Vec3(0.0), cursor).inside);
  EXPECT_TRUE(grid->sample(Vec3(0.95, 0.1, 0), cursor).inside);
  EXPECT_NEAR(grid->stats().min, 1, 1e-6);
}

}  // namespace grid_vector_test
}  // namespace catena::field
