// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "engine/base/memory_limit.h"
#include "engine/field/analytic/analytic.h"
#include "tests/engine/field/field_helpers.h"

namespace catena::field::grid_test {

using namespace test;

constexpr double inf = std::numeric_limits<double>::infinity();

bool same_bits(const ScalarSample& a, const ScalarSample& b) {
  return std::memcmp(&a.value, &b.value, sizeof a.value) == 0 && std::memcmp(&a.gradient, &b.gradient, sizeof a.gradient) == 0 &&
         a.inside == b.inside;
}

TEST(ScalarGrid, EqualsTheTrilinearFormulaForAnyMapping) {
  const Block block = random_block({19, 11, 14}, 5);
  for (const Mapping& mapping : mappings()) {
    const auto grid = make_scalar_grid("g", mapping, block.size, block.values);
    Random random(6);
    Cursor cursor;
    for (int trial = 0; trial < 3000; ++trial) {
      const Vec3 index = random.in_box(Vec3(0.0), Vec3(18, 10, 13));
      const ScalarSample s = grid->sample(mapping.world_from_index(index), cursor);
      EXPECT_TRUE(s.inside);
      ASSERT_NEAR(s.value, block.trilinear(index), 1e-12 * (1 + norm(mapping.origin)));
    }
  }
}

TEST(ScalarGrid, GradientIsACovector) {
  for (const Mapping& mapping : mappings()) {
    const auto grid = random_grid({9, 9, 9}, 7, mapping);
    Random random(8);
    Cursor cursor;
    for (int trial = 0; trial < 300; ++trial) {
      // The differences must stay within a cell.
      const Vec3 f = random.in_box(Vec3(0.1), Vec3(0.9));
      const Vec3 index =
          Vec3(static_cast<int>(random.uniform(0, 8)), static_cast<int>(random.uniform(0, 8)), static_cast<int>(random.uniform(0, 8))) + f;
      const Vec3 p = mapping.world_from_index(index);
      const ScalarSample s = grid->sample(p, cursor);
      constexpr double h = 1e-4;
      for (int a = 0; a < 3; ++a) {
        const Vec3 step = along(a, h);
        const double difference = (grid->sample(p + step, cursor).value - grid->sample(p - step, cursor).value) / (2 * h);
        ASSERT_NEAR(s.gradient[a], difference, 1e-6);
      }
    }
  }
}

TEST(ScalarGrid, ReproducesALinearFieldUpToItsFaces) {
  const auto field = make_analytic("linear").value().scalar;
  const auto grid = sample_on_grid(*field, 33, -2, 2);
  Cursor cursor;
  Random random(9);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3 p = random.in_box(Vec3(-2.0), Vec3(2.0));
    const ScalarSample s = grid->sample(p, cursor);
    ASSERT_TRUE(s.inside);
    ASSERT_NEAR(s.value, p.x + p.y + p.z, 1e-6);
    ASSERT_NEAR(norm(s.gradient - Vec3(1.0)), 0, 1e-5);
  }
  for (const Vec3& corner : {Vec3(2.0), Vec3(-2.0), Vec3(2, -2, 2)}) {
    const ScalarSample s = grid->sample(corner, cursor);
    EXPECT_TRUE(s.inside);
    EXPECT_NEAR(s.value, corner.x + corner.y + corner.z, 1e-6);
  }
}

TEST(ScalarGrid, ExtendsTheNearestCellOutside) {
  const auto grid = sample_on_grid(*make_analytic("linear").value().scalar, 17, -2, 2);
  Cursor cursor;
  const ScalarSample s = grid->sample(Vec3(5, 0, -9), cursor);
  EXPECT_FALSE(s.inside);
  EXPECT_NEAR(s.value, -4, 1e-5);
  EXPECT_NEAR(s.gradient.x, 1, 1e-6);
  EXPECT_FALSE(grid->sample(Vec3(2 + 1e-6, 0, 0), cursor).inside);
  EXPECT_TRUE(grid->sample(Vec3(2 + 1e-11, 0, 0), cursor).inside);
}

TEST(ScalarGrid, IsSafeFarAwayAndForNonFinitePoints) {
  for (const Mapping& mapping : mappings()) {
    const auto grid = random_grid({8, 8, 8}, 10, mapping);
    Cursor cursor;
    for (const double big : {1e10, 1e30, 1e200, 1e308}) {
      const ScalarSample s = grid->sample(Vec3(big, -big, big), cursor);
      EXPECT_FALSE(s.inside);
      EXPECT_TRUE(std::isfinite(s.value) && is_finite(s.gradient));
    }
    for (const double bad : {inf, -inf, std::nan("")}) {
      const ScalarSample s = grid->sample(Vec3(0, bad, 0), cursor);
      EXPECT_FALSE(s.inside);
      EXPECT_EQ(s.value, 0);
      EXPECT_EQ(s.gradient, Vec3(0.0));
    }
  }
}

TEST(ScalarGrid, CursorsNeverChangeValues) {
  const Block a = random_block({20, 20, 20}, 11), b = random_block({20, 20, 20}, 12);
  const auto grid = make_scalar_grid("a", {}, a.size, a.values), other = make_scalar_grid("b", {}, b.size, b.values);
  Random random(13);
  Cursor kept, shared;
  for (int trial = 0; trial < 3000; ++trial) {
    const Vec3 p = random.in_box(Vec3(-1.0), Vec3(20.0));
    Cursor fresh;
    const ScalarSample expected = grid->sample(p, fresh);
    ASSERT_TRUE(same_bits(expected, grid->sample(p, kept)));
    other->sample(p, shared);
    ASSERT_TRUE(same_bits(expected, grid->sample(p, shared)));
    const Cursor copied = shared;
    Cursor copy = copied;
    ASSERT_TRUE(same_bits(expected, grid->sample(p, copy)));
  }
}

TEST(ScalarGrid, ACursorOfAFreedGridIsNotTrusted) {
  // Successive grids often have the same address; their values differ.
  Cursor cursor;
  for (int n = 0; n < 50; ++n) {
    const std::vector<float> values(8, static_cast<float>(n));
    const auto grid = make_scalar_grid("g", {}, {2, 2, 2}, values);
    EXPECT_EQ(grid->sample(Vec3(0.5), cursor).value, n);
  }
}

TEST(ScalarGrid, SamplingAllocatesNothing) {
  const auto grid = random_grid({40, 40, 40}, 14);
  Random random(15);
  const AllocationCounter guard;
  Cursor cursor;
  for (int trial = 0; trial < 500; ++trial) grid->sample(random.in_box(Vec3(-5.0), Vec3(45.0)), cursor);
  EXPECT_EQ(guard.count(), 0u);
}

TEST(ScalarGrid, CellsAreClampedAndHaveTheirCornerValues) {
  const Block block = random_block({9, 10, 11}, 16);
  const auto grid = make_scalar_grid("g", {}, block.size, block.values);
  Cursor cursor;
  EXPECT_EQ(grid->cell({100, -5, 3}, cursor).base, (Index3{7, 0, 3}));
  EXPECT_EQ(grid->cell_base(Vec3(8.0, 9.0, 10.0)), (Index3{7, 8, 9}));
  EXPECT_EQ(grid->cell_base(Vec3(1e300, -1e300, std::nan(""))), (Index3{7, 0, 0}));
  for (int x = 0; x < 8; ++x) {
    const ScalarCell c = grid->cell({x, 6, 7}, cursor);
    ASSERT_TRUE(c.valid);
    for (int n = 0; n < 8; ++n) ASSERT_EQ(c.corner[n], block.at(x + (n & 1), 6 + (n >> 1 & 1), 7 + (n >> 2)));
  }
}

TEST(ScalarGrid, OneLayerHasNoDerivativeAcross) {
  const Block block = random_block({6, 7, 1}, 17);
  const auto grid = make_scalar_grid("g", {}, block.size, block.values);
  Cursor cursor;
  const ScalarSample s = grid->sample(Vec3(2.25, 3.5, 0), cursor);
  EXPECT_TRUE(s.inside);
  EXPECT_EQ(s.gradient.z, 0);
  EXPECT_NEAR(s.value, 0.5 * (0.75 * block.at(2, 3, 0) + 0.25 * block.at(3, 3, 0) + 0.75 * block.at(2, 4, 0) + 0.25 * block.at(3, 4, 0)),
              1e-6);
  EXPECT_FALSE(grid->sample(Vec3(2.25, 3.5, 0.1), cursor).inside);
  EXPECT_EQ(grid->cell_base(Vec3(2, 3, 5)).z, 0);
  // A layer with a mask still has cells.
  std::vector<std::uint8_t> valid(16, 1);
  valid[15] = 0;
  const auto masked = make_scalar_grid("g", {}, {4, 4, 1}, std::vector<float>(16, 1.f), valid);
  EXPECT_TRUE(masked->cell({0, 0, 0}, cursor).valid);
  EXPECT_FALSE(masked->cell({2, 2, 0}, cursor).valid);
}

TEST(ScalarGridMask, ACellNeedsEightValidCorners) {
  const Block block = random_block({21, 17, 13}, 18);
  Random random(19);
  std::vector<std::uint8_t> valid(block.values.size());
  for (auto& v : valid) v = random.uniform(0, 1) < 0.93;
  const auto grid = make_scalar_grid("g", {}, block.size, block.values, valid);
  EXPECT_TRUE(grid->has_mask());
  const auto is_valid = [&](int x, int y, int z) { return valid[(static_cast<std::size_t>(z) * 17 + y) * 21 + x] != 0; };
  std::vector<std::uint8_t> cells(valid.size());
  grid->read_cell_validity({0, 0, 0}, block.size, cells);
  Cursor cursor;
  int counted = 0;
  std::size_t n = 0;
  for (int z = 0; z < 13; ++z)
    for (int y = 0; y < 17; ++y)
      for (int x = 0; x < 21; ++x, ++n) {
        bool all = x < 20 && y < 16 && z < 12;
        for (int c = 0; c < 8 && all; ++c) all = is_valid(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
        ASSERT_EQ(cells[n] != 0, all);
        if (x < 20 && y < 16 && z < 12) {
          ASSERT_EQ(grid->cell({x, y, z}, cursor).valid, all);
          ASSERT_EQ(grid->sample(Vec3(x + 0.5, y + 0.5, z + 0.5), cursor).inside, all);
        }
        counted += all;
      }
  EXPECT_GT(counted, 500);
  EXPECT_LT(counted, 20 * 16 * 12);
}

TEST(ScalarGridMask, RangesCountValidVoxelsOnly) {
  std::vector<float> values(27, 5.f);
  std::vector<std::uint8_t> valid(27, 1);
  values[0] = -1000, valid[0] = 0;
  values[26] = 7;
  const auto grid = make_scalar_grid("g", {}, {3, 3, 3}, values, valid);
  EXPECT_EQ(grid->min_value(), 5);
  EXPECT_EQ(grid->max_value(), 7);
  EXPECT_EQ(grid->stats().active_voxels, 26u);
}

TEST(ScalarGrid, NonFiniteVoxelsAreCountedAndTheirCellsInvalid) {
  Block block = random_block({10, 10, 10}, 20);
  block.values[555] = std::nanf("");
  block.values[777] = std::numeric_limits<float>::infinity();
  const auto grid = make_scalar_grid("g", {}, block.size, block.values);
  EXPECT_EQ(grid->stats().nan_count, 2u);
  EXPECT_TRUE(std::isfinite(grid->max_value()));
  Cursor cursor;
  EXPECT_FALSE(grid->sample(Vec3(5, 5, 5), cursor).inside);
  EXPECT_FALSE(grid->cell({4, 4, 4}, cursor).valid);
  EXPECT_TRUE(grid->cell({2, 2, 2}, cursor).valid);
  EXPECT_TRUE(grid->has_mask());
  std::vector<std::uint8_t> cells(1000);
  grid->read_cell_validity({0, 0, 0}, block.size, cells);
  EXPECT_EQ(std::count(cells.begin(), cells.end(), 0), 1000 - 729 + 16);
}

TEST(ScalarGrid, ANanInAConstantBlockIsNotPrunedAway) {
  std::vector<float> values(16 * 16 * 16, 3.0f);
  values[(5 * 16 + 6) * 16 + 7] = std::nanf("");
  const auto grid = make_scalar_grid("g", Mapping{}, {16, 16, 16}, values);
  EXPECT_EQ(grid->stats().nan_count, 1u);
  Cursor cursor;
  EXPECT_FALSE(grid->sample(Vec3(7.25, 6.25, 5.25), cursor).inside);
  EXPECT_TRUE(grid->sample(Vec3(9.25, 6.25, 5.25), cursor).inside);
}

TEST(ScalarGrid, BlocksAreCopiedAsStored) {
  const Block block = random_block({21, 18, 19}, 21);
  const auto grid = make_scalar_grid("g", {}, block.size, block.values);
  const Index3 origin{-3, 5, 6}, size{20, 11, 14};
  std::vector<float> out(static_cast<std::size_t>(size.x) * size.y * size.z, -99.f);
  grid->read_block(origin, size, out);
  std::size_t n = 0;
  for (int z = 6; z < 20; ++z)
    for (int y = 5; y < 16; ++y)
      for (int x = -3; x < 17; ++x, ++n) {
        const bool in = x >= 0 && y < 18 && z < 19;
        ASSERT_EQ(out[n], in ? block.at(x, y, z) : grid->background());
      }
}

TEST(ScalarGrid, RunsOfOneValueAreConstantBlocks) {
  std::vector<float> values(72 * 72 * 72, 2.5f);
  values[0] = 1;
  const auto grid = make_scalar_grid("g", {}, {72, 72, 72}, values);
  float value = 0;
  EXPECT_FALSE(grid->is_constant_block({0, 0, 0}, value));
  EXPECT_TRUE(grid->is_constant_block({8, 16, 0}, value));
  EXPECT_EQ(value, 2.5f);
  EXPECT_TRUE(grid->is_constant_block({80, 0, 0}, value));
  EXPECT_EQ(value, grid->background());
  EXPECT_EQ(grid->stats().active_voxels, 72u * 72 * 72);
  EXPECT_LT(grid->bytes(), 4u * 72 * 72 * 72 / 3);
}

TEST(Field, TheDomainLengthIsTheLongestEdgeAndVersionsDiffer) {
  const std::vector<float> values(3 * 5 * 4, 1.f);
  const auto a = make_scalar_grid("g", Mapping::from_linear(Mat3(3, 0, 0, 0, 1, 0, 0, 0, 2), Vec3(0.0)), {3, 5, 4}, values);
  const auto b = make_scalar_grid("g", {}, {3, 5, 4}, values);
  EXPECT_DOUBLE_EQ(a->domain_length(), 6);
  EXPECT_DOUBLE_EQ(b->domain_length(), 4);
  EXPECT_NE(a->version(), b->version());
}

TEST(VectorGrid, EqualsTheTrilinearFormulaInEachComponent) {
  const Index3 size{12, 17, 10};
  const std::array<Block, 3> parts{random_block(size, 1), random_block(size, 2), random_block(size, 3)};
  std::vector<float> xyz;
  for (std::size_t n = 0; n < parts[0].values.size(); ++n)
    for (const Block& part : parts) xyz.push_back(part.values[n]);
  for (const Mapping& mapping : mappings()) {
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

TEST(VectorGrid, ReportsWhyAPositionIsOutside) {
  std::vector<float> xyz(3 * 64, 1.f);
  std::vector<std::uint8_t> valid(64, 1);
  valid[63] = 0;
  xyz[0] = std::nanf("");
  const auto grid = make_vector_grid("v", {}, {4, 4, 4}, xyz, valid);
  EXPECT_TRUE(grid->has_mask());
  Cursor cursor;
  for (const auto& [at, status] : {std::pair{Vec3(1.5), SampleStatus::ok},
                                   {Vec3(1.5, 2.5, 2.5), SampleStatus::ok},
                                   {Vec3(2.5), SampleStatus::masked},
                                   {Vec3(0.5), SampleStatus::not_finite},
                                   {Vec3(1.5, 1.5, 3.1), SampleStatus::outside_box},
                                   {Vec3(std::nan("")), SampleStatus::not_finite}}) {
    EXPECT_EQ(grid->status_outside(at, cursor), status) << at.x << " " << at.y << " " << at.z;
    EXPECT_EQ(grid->sample(at, cursor).inside, status == SampleStatus::ok) << at.x << " " << at.y << " " << at.z;
  }
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

}  // namespace catena::field::grid_test
