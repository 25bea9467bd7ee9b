// SPDX-License-Identifier: MIT
/// Masks of cells together with masks of voxels: a cell is valid if both masks allow it, in a grid and in grids derived from it.
#include <gtest/gtest.h>

#include "engine/field/derived/box_downsample.h"
#include "engine/field/derived/magnitude.h"
#include "engine/io/volume/downsample.h"
#include "tests/engine/field/field_helpers.h"
#include "tests/fuzz/mutate.h"

namespace catena::field::cell_mask_test {

struct Made {
  Index3 n{150, 37, 21};  // more than a node of 128 along x
  std::vector<float> values;
  std::vector<std::uint8_t> valid, cells;

  /// Makes large holes and single invalid cells, and holes of voxels.
  Made() {
    catena::test::Random random{3};
    for (int z = 0; z < n.z; ++z)
      for (int y = 0; y < n.y; ++y)
        for (int x = 0; x < n.x; ++x) {
          values.push_back(static_cast<float>(x + 2 * y + 3 * z));
          valid.push_back(x < 60 || x >= 72 || random.below(9) != 0 ? 1 : 0);
          cells.push_back((x < 100 || x > 130 || y > 20) && (x > 50 || random.below(20) != 0) ? 1 : 0);
        }
  }
  std::size_t at(int x, int y, int z) const { return static_cast<std::size_t>((z * n.y + y) * n.x + x); }
  bool expected(int x, int y, int z) const {
    if (x < 0 || y < 0 || z < 0 || x + 1 >= n.x || y + 1 >= n.y || z + 1 >= n.z) return false;
    bool all = cells[at(x, y, z)] != 0;
    for (int c = 0; c < 8; ++c) all = all && valid[at(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2))] != 0;
    return all;
  }
  std::shared_ptr<const ScalarGrid> grid() const { return make_scalar_grid("g", {}, n, values, valid, cells); }
};

void expect_cells(const Made& made, const ScalarGrid& grid) {
  EXPECT_TRUE(grid.has_cell_mask());
  std::vector<std::uint8_t> found(made.values.size());
  grid.read_cell_validity({0, 0, 0}, made.n, found);
  int wrong = 0;
  for (int z = 0; z < made.n.z; ++z)
    for (int y = 0; y < made.n.y; ++y)
      for (int x = 0; x < made.n.x; ++x) wrong += (found[made.at(x, y, z)] != 0) != made.expected(x, y, z) ? 1 : 0;
  EXPECT_EQ(wrong, 0);
}

TEST(CellMask, ACellIsValidIfBothMasksAllowIt) {
  const Made made;
  expect_cells(made, *made.grid());
  // Without an invalid cell of its own, a grid has a mask of voxels only.
  EXPECT_FALSE(make_scalar_grid("g", {}, made.n, made.values, made.valid)->has_cell_mask());
}

TEST(CellMask, AVdbStoresIt) {
  const Made made;
  const test::TemporaryFolder folder;
  const AnyField field{made.grid(), nullptr};
  ASSERT_TRUE(write_vdb(folder / "m.vdb", {{field, "g"}}));
  LoadRequest request = test::request_for(folder / "m.vdb");
  expect_cells(made, *test::value_of(load(request)).scalar->grid());
  request.mask_grid = std::nullopt;
  EXPECT_FALSE(load(request)->scalar->grid()->has_mask());
}

TEST(CellMask, MagnitudesOfVectorsHaveIt) {
  const Made made;
  std::vector<float> xyz;
  for (const float v : made.values) xyz.insert(xyz.end(), {v, 0, 0});
  const auto lengths = test::value_of(make_magnitude_grid(*make_vector_grid("g", {}, made.n, xyz, made.valid, made.cells), "lengths"));
  expect_cells(made, *lengths);
}

TEST(CellMask, CoarseCellsAreInvalidIfHalfOfTheFineOnesAre) {
  // A wall two cells thick, from voxel 20 to 22.
  const Index3 n{41, 33, 25};
  std::vector<float> values(static_cast<std::size_t>(n.x * n.y * n.z), 1.f);
  std::vector<std::uint8_t> valid(values.size(), 1), cells(values.size(), 1);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto x = static_cast<int>(i % static_cast<std::size_t>(n.x));
    if (x == 20 || x == 21) cells[i] = 0;
    values[i] = static_cast<float>(x);
  }
  const AnyField field{make_scalar_grid("g", {}, n, values, valid, cells), nullptr};
  const auto level = test::value_of(downsample_to_level("g", field, 1, false));
  const auto coarse = test::value_of(box_downsample(*field.scalar->grid(), 2));
  for (const ScalarGrid* grid : {level.scalar->grid(), coarse.grid.get()}) {
    Cursor cursor;
    EXPECT_FALSE(grid->sample({21, 16, 12}, cursor).inside);
    for (const double x : {4.0, 18.0, 24.0, 36.0}) {
      const ScalarSample sample = grid->sample({x, 16, 12}, cursor);
      EXPECT_TRUE(sample.inside) << x;
      EXPECT_NEAR(sample.value, x, 1e-4);
    }
  }
}

}  // namespace catena::field::cell_mask_test
