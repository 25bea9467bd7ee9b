// SPDX-License-Identifier: MIT
/// Slabs of paged grids: the values of the finest level in the plane, by the grid in memory.
#include "engine/field/bricks/slab.h"

#include <gtest/gtest.h>

#include "tests/support/formula_bricks.h"

namespace catena::field::slab_test {

using test::FormulaBricks;

constexpr double kEdge = 0.1;

std::shared_ptr<const FormulaBricks> waves() {
  return std::make_shared<const FormulaBricks>(Index3{150, 130, 70}, kEdge, [](const Vec3& p) {
    return 30000 + 9000 * std::sin(7 * p.x + 3 * p.y) + 9000 * std::cos(5 * p.z - 4 * p.y);
  });
}

std::shared_ptr<const ScalarGrid> slab_of(const PagedGrid& grid, const Vec3& point, const Vec3& normal) {
  return test::value_of(make_slab(grid, point, normal, [] { return false; }));
}

/// Returns the largest difference from the grid in memory, at positions in the plane; `count`: positions that the slab contains.
double difference(const ScalarGrid& slab, const ScalarGrid& whole, const Vec3& point, const Vec3& normal, int& count) {
  const Vec3 across = cross(normal, Vec3(0.3, 0.5, 0.8)), u = across / norm(across), v = cross(normal, u) / norm(normal);
  Cursor a, b;
  double worst = 0;
  count = 0;
  for (double s = -20; s < 20; s += 0.173)
    for (double t = -20; t < 20; t += 0.191) {
      const Vec3 p = point + u * s + v * t;
      const ScalarSample x = slab.sample(p, a), y = whole.sample(p, b);
      if (!x.inside || !y.inside) continue;
      ++count;
      worst = std::max(worst, std::fabs(x.value - y.value));
    }
  return worst;
}

TEST(Slab, APlaneAlongTheVoxelsHasTheirValues) {
  const auto source = waves();
  const auto grid = test::make_paged(source);
  for (const Vec3& normal : {Vec3(1, 0, 0), Vec3(0, -2, 0), Vec3(0, 0, 1)}) {
    const Vec3 point(7.23, 6.41, 3.37);
    const auto slab = slab_of(*grid, point, normal);
    ASSERT_NE(slab, nullptr);
    int count = 0;
    EXPECT_LT(difference(*slab, *source->whole(0), point, normal, count), 1e-2);
    EXPECT_GT(count, 1000);
  }
}

TEST(Slab, AnyOtherPlaneIsInterpolated) {
  const auto source = waves();
  const auto grid = test::make_paged(source);
  const Vec3 point(7, 6, 3.5), normal(0.4, 0.7, -0.6);
  int count = 0;
  const auto slab = slab_of(*grid, point, normal);
  ASSERT_NE(slab, nullptr);
  EXPECT_LT(difference(*slab, *source->whole(0), point, normal, count), 800) << "of 36000; interpolated twice";
  EXPECT_GT(count, 1000);
}

TEST(Slab, WithoutAPlaneInTheGridThereIsNone) {
  const auto grid = test::make_paged(waves());
  EXPECT_EQ(slab_of(*grid, Vec3(-1, 0, 0), Vec3(1, 0, 0)), nullptr);
  EXPECT_EQ(slab_of(*grid, Vec3(-1, -1, -1), Vec3(1, 1, 1)), nullptr);
  EXPECT_EQ(test::value_of(make_slab(*grid, Vec3(7, 6, 3), Vec3(0, 0, 1), [] { return true; })), nullptr);
}

}  // namespace catena::field::slab_test
