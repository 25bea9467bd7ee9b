// SPDX-License-Identifier: MIT
/// Label maps: values of the nearest voxel, never mixed, and the positions of label surfaces.
#include "engine/field/derived/label_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "engine/field/derived/box_downsample.h"
#include "tests/engine/field/field_helpers.h"
#include "tests/fuzz/mutate.h"

namespace catena::field::label_surface_test {

/// A rotated, anisotropic mapping away from the origin.
Mapping turned() {
  const Mat3 turn = Mat3(Vec3(0.8, 0.6, 0.0), Vec3(-0.6, 0.8, 0.0), Vec3(0.0, 0.0, 1.0));
  return Mapping::from_linear(turn * Mat3(Vec3(1.5, 0, 0), Vec3(0, 0.5, 0), Vec3(0, 0, 2)), {7, -3, 11});
}

template <class Label>
std::shared_ptr<const ScalarGrid> map_of(const Index3& n, const Label& label, const Mapping& mapping = turned()) {
  return make_scalar_grid("map", mapping, n, test::values_of(n, label))->with_interpolation(Interpolation::nearest);
}

/// Labels such that the mean of two neighbors may be another label, and with large differences.
double scattered(int x, int y, int z) {
  constexpr double labels[] = {0, 17, 34, 2035, 14175};
  return labels[(7 * x + 11 * y + 5 * z + x * y) % 5];
}

TEST(Nearest, APositionHasTheValueOfTheNearestVoxelAndNoGradient) {
  const auto map = map_of({13, 9, 11}, scattered);
  catena::test::Random random{3};
  const auto share = [&] { return double(random.next() >> 11) * 0x1p-53; };
  Cursor cursor;
  for (int i = 0; i < 100000; ++i) {
    const Vec3 index(-0.5 + 13 * share(), -0.5 + 9 * share(), -0.5 + 11 * share());
    const ScalarSample s = map->sample(map->mapping().world_from_index(index), cursor);
    const bool inside = map->index_box().contains(index);
    ASSERT_EQ(s.inside, inside) << index.x << " " << index.y << " " << index.z;
    if (!inside) continue;
    ASSERT_EQ(s.value, scattered(int(std::lround(index.x)), int(std::lround(index.y)), int(std::lround(index.z))));
    ASSERT_EQ(norm(s.gradient), 0);
  }
}

TEST(Nearest, BothInterpolationsReadTheSameVoxels) {
  const auto nearest = map_of({4, 4, 4}, [](int x, int, int) { return x; }, {});
  const auto linear = nearest->with_interpolation(Interpolation::linear);
  Cursor a, b;
  EXPECT_EQ(nearest->sample({1.4, 1, 1}, a).value, 1);
  EXPECT_EQ(nearest->sample({1.5, 1, 1}, a).value, 2);
  EXPECT_EQ(linear->sample({1.4, 1, 1}, b).value, 1.4);
  EXPECT_NE(nearest->version(), linear->version());
}

TEST(Nearest, DownsamplingInventsNoLabel) {
  const auto map = map_of({37, 40, 33}, scattered);
  std::set<double> labels;
  const auto fine = count_labels(*map).value();
  for (const LabelCount& count : fine) labels.insert(count.value);
  for (const int factor : {2, 4, 8}) {
    const auto coarse = test::value_of(box_downsample(*map, factor));
    EXPECT_EQ(coarse.grid->interpolation(), Interpolation::nearest);
    const auto counts = count_labels(*coarse.grid).value();
    for (const LabelCount& count : counts) EXPECT_TRUE(labels.contains(count.value)) << count.value;
  }
}

TEST(LabelCounts, HaveVoxelsAndABoxForEveryValue) {
  const auto map = map_of({20, 30, 40}, [](int x, int y, int z) { return x == 3 && y >= 4 && y <= 6 && z == 25 ? 9 : 0; });
  const auto counts = count_labels(*map);
  ASSERT_TRUE(counts && counts->size() == 2);
  EXPECT_EQ(counts->front().voxels, 20 * 30 * 40 - 3u);
  const LabelCount& nine = counts->back();
  EXPECT_EQ(nine.value, 9);
  EXPECT_EQ(nine.voxels, 3u);
  EXPECT_EQ(nine.lo, (Index3{3, 4, 25}));
  EXPECT_EQ(nine.hi, (Index3{3, 6, 25}));
  EXPECT_FALSE(count_labels(*map_of({4, 4, 4}, [](int x, int, int) { return 0.5 * x; }))) << "no whole numbers";
}

/// Two labels that meet at x = 5.5: the surface is halfway between voxel centers, for any mapping.
TEST(LabelSurface, LiesHalfwayBetweenTheVoxelCentresOfTwoLabels) {
  const auto map = map_of({12, 10, 10}, [](int x, int, int) { return x <= 5 ? 17 : 18; });
  const auto surface = test::value_of(make_label_surface(*map, *count_labels(*map), {17}, 0, "left"));
  Cursor cursor;
  for (const double y : {1.0, 4.3, 7.9}) {
    const Vec3 met = map->mapping().world_from_index({5.5, y, 4.2});
    const ScalarSample s = surface->sample(met, cursor);
    ASSERT_TRUE(s.inside);
    EXPECT_NEAR(s.value, kLabelLevel, 1e-12);
    // Along x the values fall from 1 to 0 over one voxel, whose length is 1.5.
    EXPECT_NEAR(norm(s.gradient), 1 / 1.5, 1e-9);
  }
}

/// A plane of the world in two grids with different orientations: the surface of a label in one is the zero level of a distance in the
/// other.
TEST(LabelSurface, HasTheWorldPositionOfAnotherGridsPlane) {
  const auto map = map_of({12, 10, 10}, [](int x, int, int) { return x <= 5 ? 17 : 0; });
  const Mapping& mapping = map->mapping();
  const Vec3 on = mapping.world_from_index({5.5, 4, 4}), normal = direction(mapping.world_from_index_linear[0]);
  const Mat3 turn = Mat3(Vec3(0.6, 0, 0.8), Vec3(0, 1, 0), Vec3(-0.8, 0, 0.6));
  const Mapping other = Mapping::from_linear(turn * Mat3(0.75), on - turn * Vec3(9.3, 8.1, 8.6));
  const auto distances =
      test::values_of({24, 24, 24}, [&](int x, int y, int z) { return dot(normal, other.world_from_index(Vec3(x, y, z)) - on); });
  const auto distance = make_scalar_grid("distance", other, {24, 24, 24}, distances);
  const auto surface = test::value_of(make_label_surface(*map, *count_labels(*map), {17}, 0, "s"));
  Cursor cursor, cursor2;
  for (const double y : {2.0, 4.7, 6.1}) {
    Vec3 lo = mapping.world_from_index({4.6, y, 4.4}), hi = mapping.world_from_index({6.4, y, 4.4});
    for (int step = 0; step < 60; ++step) {
      const Vec3 middle = 0.5 * (lo + hi);
      (surface->sample(middle, cursor).value > kLabelLevel ? lo : hi) = middle;
    }
    const ScalarSample there = distance->sample(lo, cursor2);
    ASSERT_TRUE(there.inside);
    EXPECT_NEAR(there.value, 0, 1e-6);
  }
}

TEST(LabelSurface, SeveralLabelsHaveNoInnerWallAndAClosedSurface) {
  const auto map = map_of({12, 10, 10}, [](int x, int, int) { return x <= 5 ? 17 : 18; });
  const auto both = test::value_of(make_label_surface(*map, *count_labels(*map), {17, 18}, 0, "both"));
  Cursor cursor;
  EXPECT_EQ(both->sample(map->mapping().world_from_index({5.5, 5, 5}), cursor).value, 1);
  EXPECT_NEAR(both->sample(map->mapping().world_from_index({-0.5, 5, 5}), cursor).value, 0.5, 1e-12);
  EXPECT_EQ(both->sample(map->mapping().world_from_index({-1, 5, 5}), cursor).value, 0);
}

/// Each voxel center stays on its side of the smoothed surface, for any shape: thin sheets, single voxels and holes.
TEST(LabelSurface, SmoothingKeepsEveryVoxelCenterOnItsSide) {
  const auto label = [](int x, int y, int z) {
    const double r = std::hypot(x - 15.0, y - 15.0, z - 15.0);
    const bool sheet = x == 28, line = x == 2 && y == 2, dot = x == 25 && y == 3 && z == 3, hole = x == 15 && y == 15 && z == 15;
    return (r < 9.3 && !hole) || sheet || line || dot ? 4 : 0;
  };
  const auto map = map_of({32, 32, 32}, label);
  for (const double smooth : {0.4, kDefaultLabelSmoothing, kMaxLabelSmoothing}) {
    const auto surface = test::value_of(make_label_surface(*map, *count_labels(*map), {4}, smooth, "s"));
    Cursor cursor;
    for (int z = -1; z < 33; ++z)
      for (int y = -1; y < 33; ++y)
        for (int x = -1; x < 33; ++x) {
          const bool in = x >= 0 && y >= 0 && z >= 0 && x < 32 && y < 32 && z < 32 && label(x, y, z) == 4;
          const double value = surface->sample(map->mapping().world_from_index(Vec3(x, y, z)), cursor).value;
          ASSERT_EQ(value > kLabelLevel, in) << x << " " << y << " " << z << " " << smooth;
        }
  }
}

/// A ball of radius 9.3: the smoothed surface is within a quarter of a voxel of the sphere, the raw one within 0.9.
TEST(LabelSurface, SmoothingReducesTheDistanceToASphere) {
  const auto ball = [](int x, int y, int z) { return std::hypot(x - 15.0, y - 15.0, z - 15.0) < 9.3 ? 1 : 0; };
  const auto map = map_of({31, 31, 31}, ball, {});
  double worst[2] = {0, 0};
  for (const int k : {0, 1}) {
    const auto surface = make_label_surface(*map, *count_labels(*map), {1}, k == 0 ? 0 : kDefaultLabelSmoothing, "ball");
    ASSERT_TRUE(surface);
    Cursor cursor;
    catena::test::Random random{5};
    for (int i = 0; i < 500; ++i) {
      const auto share = [&] { return double(random.next() >> 11) * 0x1p-53 - 0.5; };
      const Vec3 along = direction(Vec3(share(), share(), share()));
      double lo = 5, hi = 13;
      for (int step = 0; step < 50; ++step) {
        const double middle = 0.5 * (lo + hi);
        ((*surface)->sample(Vec3(15.0) + middle * along, cursor).value > kLabelLevel ? lo : hi) = middle;
      }
      worst[k] = std::max(worst[k], std::fabs(lo - 9.3));
    }
  }
  EXPECT_LT(worst[0], 0.9);
  EXPECT_LT(worst[1], 0.5);
  EXPECT_LT(worst[1], 0.7 * worst[0]);
  RecordProperty("raw", std::to_string(worst[0]));
  RecordProperty("smooth", std::to_string(worst[1]));
}

TEST(LabelSurface, TheGridOfASmallLabelIsSmall) {
  const auto map =
      map_of({160, 160, 160}, [](int x, int y, int z) { return x > 70 && x < 75 && y > 70 && y < 75 && z > 70 && z < 75 ? 2 : 1; });
  const auto surface = test::value_of(make_label_surface(*map, *count_labels(*map), {2}, kDefaultLabelSmoothing, "s"));
  EXPECT_LT(surface->bytes(), 1u << 19) << "the map has 16 MB";
}

TEST(LabelAt, FindsTheNearestLabelVoxelOfTheCell) {
  const auto map = map_of({8, 8, 8}, [](int x, int, int) { return x < 4 ? 3 : 0; }, {});
  EXPECT_EQ(label_at(*map, {3.2, 2, 2}), 3);
  EXPECT_EQ(label_at(*map, {3.8, 2, 2}), 3) << "of the cell";
  EXPECT_EQ(label_at(*map, {4.8, 2, 2}), 0);
  EXPECT_EQ(label_at(*map, {-3, 2, 2}), 0);
}

}  // namespace catena::field::label_surface_test
