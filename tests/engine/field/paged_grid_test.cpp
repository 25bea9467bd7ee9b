// SPDX-License-Identifier: MIT
#include "engine/field/bricks/paged_grid.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/formula_bricks.h"

namespace catena::field::paged_grid_test {

using test::FormulaBricks;

constexpr Index3 kSize{150, 130, 70};  // 3 x 3 x 2 bricks

std::shared_ptr<const FormulaBricks> waves() {
  return std::make_shared<const FormulaBricks>(kSize, 0.1, [](const Vec3& p) {
    return 30000 + 9000 * std::sin(7 * p.x + 3 * p.y) + 9000 * std::cos(5 * p.z - 4 * p.y) + 300 * std::sin(31 * p.x);
  });
}

std::vector<Index3> all_bricks() {
  std::vector<Index3> bricks;
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 3; ++x) bricks.push_back({x, y, z});
  return bricks;
}

struct Positions {
  std::mt19937 random{7};
  /// A position in or around the grid; some lie on faces of bricks.
  Vec3 next() {
    std::uniform_real_distribution<double> at(-0.1, 1.1);
    Vec3 index(at(random) * 149, at(random) * 129, at(random) * 69);
    if (random() % 4 == 0) index[static_cast<int>(random() % 3)] = 64.0 * static_cast<double>(random() % 3) - (random() % 2 ? 0.5 : 0.0);
    return index * 0.1;
  }
};

TEST(PagedGrid, WithAllBricksItIsTheGridInMemoryToTheBit) {
  for (const Interpolation interpolation : {Interpolation::linear, Interpolation::nearest}) {
    const auto source = waves();
    const auto whole = source->whole(0)->with_interpolation(interpolation);
    const auto paged = test::make_paged(source)->over(source->whole(1)->with_interpolation(interpolation), source->levels()[0].mapping);
    const BrickSnapshot all = test::make_snapshot(*paged, all_bricks());
    Cursor a, b;
    b.bricks = &all;
    Positions positions;
    for (int i = 0; i < 20000; ++i) {
      const Vec3 p = positions.next();
      const ScalarSample x = whole->sample(p, a), y = paged->sample(p, b);
      ASSERT_EQ(std::memcmp(&x.value, &y.value, 8) | std::memcmp(&x.gradient, &y.gradient, 24), 0) << p.x << " " << p.y << " " << p.z;
      ASSERT_EQ(x.inside, y.inside);
      ASSERT_EQ(whole->status_outside(p, a), paged->status_outside(p, b));
      const Index3 base = whole->cell_base(p * 10.0);
      ASSERT_EQ(base, paged->cell_base(p * 10.0));
      ASSERT_EQ(whole->cell(base, a).corner, paged->cell(base, b).corner);
    }
    EXPECT_FALSE(b.is_coarse);
  }
}

TEST(PagedGrid, WithoutBricksItIsTheCoarseLevelAtItsNodes) {
  const auto source = waves();
  const auto paged = test::make_paged(source);
  const auto coarse = source->whole(1);
  Cursor a, b;
  Positions positions;
  for (int i = 0; i < 2000; ++i) {
    const Index3 base = paged->cell_base(positions.next() * 10.0);
    const Box& box = coarse->index_box();
    const Vec3 at =
        glm::clamp(coarse->mapping().index_from_world(paged->mapping().world_from_index(Vec3(base.x, base.y, base.z))), box.lo, box.hi);
    const double expected = coarse->sample(coarse->mapping().world_from_index(at), a).value;
    ASSERT_NEAR(paged->cell(base, b).corner[0], expected, 4e-7 * 60000);
  }
  EXPECT_TRUE(b.is_coarse);
  EXPECT_EQ(b.missing_grid, paged->version());
}

TEST(PagedGrid, IsContinuousWhereABrickIsMissing) {
  const auto source = waves();
  const auto paged = test::make_paged(source);
  const BrickSnapshot some = test::make_snapshot(*paged, {{0, 0, 0}, {1, 1, 0}, {2, 0, 1}});
  Cursor cursor;
  cursor.bricks = &some;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(0, 1);
  for (int i = 0; i < 5000; ++i) {
    Vec3 index(at(random) * 149, at(random) * 129, at(random) * 69);
    index[i % 3] = i % 3 == 2 ? 63 + i % 2 : 63 + 64 * (i / 3 % 2) + i / 6 % 2;  // faces of the cells between two bricks
    Vec3 step(0.0);
    step[i % 3] = 1e-9;
    const double before = paged->sample((index - step) * 0.1, cursor).value, after = paged->sample((index + step) * 0.1, cursor).value;
    ASSERT_NEAR(before, after, 1e-3);
  }
}

TEST(PagedGrid, APartBeginsAnywhere) {
  const auto source = waves();
  const Index3 first{40, 70, 3}, size{100, 50, 66};
  const Mapping mapping = Mapping::from_linear(Mat3(0.1), source->levels()[0].mapping.world_from_index(Vec3(40, 70, 3)));
  const PagedGrid part(source, {first, size, mapping}, source->whole(1));
  const BrickSnapshot all = test::make_snapshot(part, all_bricks());
  const auto whole = source->whole(0);
  Cursor a, b;
  b.bricks = &all;
  for (int z = 0; z < 65; z += 7)
    for (int y = 0; y < 49; y += 5)
      for (int x = 0; x < 99; x += 3)
        ASSERT_EQ(part.cell({x, y, z}, b).corner, whole->cell({x + first.x, y + first.y, z + first.z}, a).corner);
  EXPECT_FALSE(b.is_coarse);
}

TEST(BrickSnapshot, FindsItsBricksAndNoOthers) {
  std::vector<StoredBrick> bricks;
  const auto brick = std::make_shared<const Brick>(*find_number_type("uint8"), Index3{1, 1, 1}, std::vector<std::byte>(1));
  for (std::uint64_t i = 0; i < 5000; ++i) bricks.push_back({{i % 3, i * i}, brick});
  const BrickSnapshot snapshot(9, bricks);
  EXPECT_EQ(snapshot.number(), 9u);
  for (std::uint64_t i = 0; i < 5000; ++i) {
    EXPECT_EQ(snapshot.find({i % 3, i * i}), brick.get());
    EXPECT_EQ(snapshot.find({i % 3 + 3, i * i}), nullptr);
    EXPECT_EQ(snapshot.find({i % 3, i * i + 5000 * 5000}), nullptr);
  }
  EXPECT_EQ(BrickSnapshot(1, {}).find({0, 0}), nullptr);
}

}  // namespace catena::field::paged_grid_test
