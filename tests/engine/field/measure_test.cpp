// SPDX-License-Identifier: MIT
/// Statistics of labels, connected parts, histograms, profiles and angles against independent computations.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "engine/field/measure/histogram.h"
#include "engine/field/measure/labels.h"
#include "engine/field/measure/parts.h"
#include "engine/field/measure/profile.h"
#include "tests/engine/field/field_helpers.h"

namespace catena::field::measure_test {

using test::value_of;
using test::values_of;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(Moments, DeviationOfALargeNumberSurvivesAnyOrderOfMerging) {
  test::Random random(3);
  std::vector<double> offsets;
  for (int i = 0; i < 20000; ++i) offsets.push_back(std::round(random.uniform(-1, 1) * 1024) * 0x1p-20);  // exact next to 1e9
  double mean = 0, squares = 0;
  for (const double v : offsets) mean += v / double(offsets.size());
  for (const double v : offsets) squares += (v - mean) * (v - mean);
  const double expected = std::sqrt(squares / double(offsets.size() - 1));
  Moments whole, joined;
  for (std::size_t i = 0; i < offsets.size();) {
    Moments part;
    for (std::size_t n = 0; n < 777 && i < offsets.size(); ++n, ++i) part.add(1e9 + offsets[i]), whole.add(1e9 + offsets[i]);
    joined.merge(part);
  }
  for (const Moments* moments : {&whole, &joined}) {
    EXPECT_NEAR(moments->deviation(), expected, 1e-9 * expected);
    EXPECT_NEAR(moments->mean() - 1e9, mean, 2e-7);
    EXPECT_EQ(moments->count(), offsets.size());
  }
  Moments one;
  one.add(4);
  EXPECT_TRUE(std::isnan(one.deviation()));
  EXPECT_TRUE(std::isnan(Moments().mean()));
}

/// A label map with a mask and NaN, and a second field with holes on the same lattice.
struct Labeled {
  Index3 n{37, 20, 43};
  std::vector<float> labels, values;
  std::vector<std::uint8_t> valid;
  std::shared_ptr<const ScalarGrid> map, field;

  explicit Labeled(const Mapping& mapping) {
    test::Random random(11);
    labels =
        values_of(n, [&](int x, int, int z) { return x == 5 && z == 7 ? kNan : std::floor(random.uniform(-2, 4)) * (z > 20 ? 100 : 1); });
    values = values_of(n, [&](int x, int y, int) { return x == 9 && y < 6 ? kNan : 1000 + random.uniform(-1, 1); });
    valid = values_of<std::uint8_t>(n, [&](int x, int y, int z) { return x + y + z > 12; });
    map = make_scalar_grid("m", mapping, n, labels, valid);
    field = make_scalar_grid("v", mapping, n, values);
  }
};

TEST(MeasureLabels, EqualACountOfTheVoxelsWithoutMaskAndNan) {
  for (const Mapping& mapping : test::mappings()) {
    const Labeled data(mapping);
    struct Sum {
      std::uint64_t voxels = 0, valued = 0;
      double sum = 0, squares = 0;
      Vec3 positions{0.0};
    };
    std::map<float, Sum> expected;
    std::uint64_t masked = 0, not_finite = 0;
    for (int pass = 0; pass < 2; ++pass)
      for (std::size_t i = 0; i < data.labels.size(); ++i) {
        if (data.valid[i] == 0 || std::isnan(data.labels[i])) {
          if (pass == 0) ++(data.valid[i] == 0 ? masked : not_finite);
          continue;
        }
        Sum& sum = expected[data.labels[i] == 0 ? 0.f : data.labels[i]];
        const int at = static_cast<int>(i);
        if (pass == 0) ++sum.voxels, sum.positions += mapping.world_from_index(Vec3(at % 37, at / 37 % 20, at / 740));
        if (std::isnan(data.values[i])) continue;
        if (pass == 0)
          ++sum.valued, sum.sum += data.values[i];
        else
          sum.squares += std::pow(data.values[i] - sum.sum / double(sum.valued), 2);
      }
    const MeasuredLabels measured = value_of(measure_labels(*data.map, data.field.get()));
    EXPECT_EQ(measured.left_out.masked, masked);
    EXPECT_EQ(measured.left_out.not_finite, not_finite);
    ASSERT_EQ(measured.labels.size(), expected.size());
    std::size_t n = 0;
    for (const auto& [label, sum] : expected) {
      const MeasuredLabel& one = measured.labels[n++];
      EXPECT_EQ(one.label, label);
      EXPECT_EQ(one.voxels, sum.voxels);
      EXPECT_EQ(one.values.count(), sum.valued);
      EXPECT_NEAR(one.values.mean(), sum.sum / double(sum.valued), 1e-9);
      EXPECT_NEAR(one.values.deviation(), std::sqrt(sum.squares / double(sum.valued - 1)), 1e-9);
      EXPECT_LT(norm(one.centroid(mapping) - sum.positions / double(sum.voxels)), 1e-9);
    }
  }
}

TEST(MeasureLabels, ValuesOnAnotherLatticeAreInterpolated) {
  const Index3 n{9, 8, 7};
  const Mapping coarse = Mapping::from_linear(Mat3(2.0), Vec3(0.3, 0.2, 0.1));
  const auto map = make_scalar_grid("m", coarse, n, values_of(n, [](int x, int, int) { return x < 8 ? 1 : 2; }));
  const auto linear = [](const Vec3& p) { return 1 + p.x - 2 * p.y + 0.5 * p.z; };
  const Index3 fine{17, 16, 20};  // ends at x = 16, before the last voxels of the map
  const auto values = make_scalar_grid("v", Mapping{}, fine, values_of(fine, [&](int x, int y, int z) { return linear(Vec3(x, y, z)); }));
  const MeasuredLabels measured = value_of(measure_labels(*map, values.get()));
  EXPECT_FALSE(is_same_lattice(*map, *values));
  EXPECT_NEAR(measured.labels[0].values.mean(), linear(measured.labels[0].centroid(coarse)), 1e-5);
  EXPECT_EQ(measured.labels[1].voxels, 56u);
  EXPECT_EQ(measured.labels[1].values.count(), 0u);
}

TEST(MeasureLabels, FractionsAndTooManyLabelsAreErrors) {
  const Index3 n{70, 70, 70};
  EXPECT_TRUE(test::fails(
      measure_labels(*make_scalar_grid("m", {}, n, values_of(n, [](int x, int y, int z) { return x + 70 * (y + 70 * z); })), nullptr),
      "more than 65536 labels"));
  EXPECT_TRUE(test::fails(
      measure_labels(*make_scalar_grid("m", {}, n, values_of(n, [](int x, int, int z) { return x == 3 && z == 60 ? 0.5 : 1; })), nullptr),
      "voxel 3 0 60 holds 0.5"));
  EXPECT_TRUE(
      test::fails(measure_labels(*make_scalar_grid("m", {}, n, values_of(n, [](int, int, int) { return 1e20; })), nullptr), "1e20"));
}

/// Sizes of the parts by a flood fill, in falling order.
std::vector<std::uint64_t> flood(const Index3& n, std::vector<std::uint8_t> above, bool all_neighbors) {
  std::vector<std::uint64_t> sizes;
  std::vector<int> stack;
  for (std::size_t start = 0; start < above.size(); ++start) {
    if (above[start] == 0) continue;
    above[start] = 0;
    stack.assign(1, static_cast<int>(start));
    std::uint64_t size = 0;
    for (; !stack.empty(); ++size) {
      const int at = stack.back(), x = at % n.x, y = at / n.x % n.y, z = at / n.x / n.y;
      stack.pop_back();
      for (int d = 0; d < 27; ++d) {
        const int i = x + d % 3 - 1, j = y + d / 3 % 3 - 1, k = z + d / 9 - 1;
        if (!all_neighbors && std::abs(i - x) + std::abs(j - y) + std::abs(k - z) > 1) continue;
        if (i < 0 || j < 0 || k < 0 || i >= n.x || j >= n.y || k >= n.z) continue;
        const int other = (k * n.y + j) * n.x + i;
        if (std::exchange(above[static_cast<std::size_t>(other)], std::uint8_t{0}) != 0) stack.push_back(other);
      }
    }
    sizes.push_back(size);
  }
  std::sort(sizes.rbegin(), sizes.rend());
  return sizes;
}

TEST(MeasureParts, NoiseHasThePartsOfAFloodFill) {
  const Index3 n{23, 31, 37};
  for (const double level : {0.05, 0.5, 0.72, 0.93}) {
    test::Random random(17);
    const auto values = values_of(n, [&](int x, int y, int) { return x == y ? kNan : random.uniform(0, 1); });
    const auto valid = values_of<std::uint8_t>(n, [&](int x, int, int z) { return (x * z) % 7 != 3; });
    const auto grid = make_scalar_grid("g", {}, n, values, valid);
    std::vector<std::uint8_t> above;
    for (std::size_t i = 0; i < values.size(); ++i) above.push_back(valid[i] != 0 && values[i] >= level ? 1 : 0);
    for (const Neighbors neighbors : {Neighbors::faces, Neighbors::all}) {
      const auto expected = flood(n, above, neighbors == Neighbors::all);
      const MeasuredParts parts = value_of(measure_parts(*grid, level, neighbors, 7, nullptr));
      ASSERT_EQ(parts.count, expected.size());
      std::uint64_t others = 0;
      for (std::size_t k = 0; k < expected.size(); ++k)
        if (k < parts.parts.size())
          EXPECT_EQ(parts.parts[k].voxels, expected[k]);
        else
          others += expected[k];
      EXPECT_EQ(parts.others.voxels, others);
      EXPECT_GE(parts.parts[0].values.min(), level);
    }
  }
}

TEST(MeasureParts, BallsThatTouchAtACornerArePartsOfFacesAndOnePartOfAllNeighbors) {
  const Index3 n{24, 24, 24};
  const auto two_balls = [](int x, int y, int z) {
    // 9 9 9 and 10 10 10 are the closest voxels
    return norm(Vec3(x - 6.4, y - 6.4, z - 6.4)) < 4.6 || norm(Vec3(x - 12.6, y - 12.6, z - 12.6)) < 4.6;
  };
  const auto grid = make_scalar_grid("g", test::mappings()[2], n, values_of(n, two_balls));
  const MeasuredParts faces = value_of(measure_parts(*grid, 0.5, Neighbors::faces, 20, nullptr));
  const MeasuredParts all = value_of(measure_parts(*grid, 0.5, Neighbors::all, 20, nullptr));
  EXPECT_EQ(faces.count, 2u);
  EXPECT_EQ(all.count, 1u);
  EXPECT_EQ(faces.parts[0].voxels + faces.parts[1].voxels, all.parts[0].voxels);
  EXPECT_EQ(faces.map.part_at({9, 9, 9}), 0u);  // of equal parts that with the first voxel is first
  EXPECT_EQ(faces.map.part_at({10, 10, 10}), 1u);
  EXPECT_FALSE(faces.map.part_at({9, 10, 10}).has_value());
  EXPECT_FALSE(faces.map.part_at({-1, 0, 0}).has_value());
  EXPECT_TRUE(test::fails(measure_parts(*grid, 2, Neighbors::all, 20, nullptr), "no voxel reaches the level 2"));
}

TEST(MeasureHistogram, BinsAreThoseOfNumPy) {
  const Index3 n{10, 10, 10};
  const auto values = values_of(n, [](int x, int y, int) { return y == 9 ? kNan : 0.1 * x; });
  const auto grid = make_scalar_grid("g", {}, n, values);
  const Histogram made = value_of(make_histogram(*grid, 9));  // edges at the values: the last bin has two of them
  ASSERT_EQ(made.counts.size(), 9u);
  for (std::size_t k = 0; k < 9; ++k) {
    std::uint64_t expected = 0;
    for (const float v : values) expected += v >= made.edges[k] && (v < made.edges[k + 1] || (k == 8 && v <= made.edges[9])) ? 1 : 0;
    EXPECT_EQ(made.counts[k], expected) << k;
  }
  EXPECT_EQ(made.left_out.not_finite, 100u);
  const Histogram part = value_of(make_histogram(*grid, 2, std::pair{0.25, 0.45}));
  EXPECT_EQ(part.below, 270u);
  EXPECT_EQ(part.above, 450u);
  EXPECT_EQ(part.counts, (std::vector<std::uint64_t>{90, 90}));
  const auto constant = make_scalar_grid("g", {}, {2, 1, 1}, std::vector<float>{3, 3});
  EXPECT_EQ(value_of(make_histogram(*constant, 2)).counts, (std::vector<std::uint64_t>{0, 2}));
}

TEST(MeasureLine, ALinearFieldIsExactAndThePointsOutsideAreEmpty) {
  const auto linear = [](const Vec3& p) { return 2 * p.x - p.y + 0.25 * p.z; };
  for (const Mapping& mapping : test::mappings()) {
    const Index3 n{12, 10, 8};
    const auto grid = make_scalar_grid("g", mapping, n,
                                       values_of(n, [&](int x, int y, int z) { return linear(mapping.world_from_index(Vec3(x, y, z))); }));
    const Vec3 a = mapping.world_from_index(Vec3(1, 1, 1)), b = mapping.world_from_index(Vec3(16, 8, 6));  // leaves the grid at x = 11
    AnyField field;
    field.scalar = grid;
    const auto line = sample_line(field, a, b, 31);
    ASSERT_EQ(line.size(), 31u);
    for (std::size_t k = 0; k < line.size(); ++k) {
      EXPECT_EQ(line[k].value.has_value(), k <= 20) << k;
      EXPECT_NEAR(line[k].length, norm(b - a) * double(k) / 30, 1e-12 * norm(b - a));
      if (line[k].value) {
        EXPECT_NEAR(line[k].value->x, linear(line[k].position), 2e-5);
      }
    }
  }
}

TEST(MeasureAngle, IsExactForSmallAndLargeTriangles) {
  for (const double size : {1e-200, 1.0, 1e200}) {
    EXPECT_NEAR(value_of(angle_deg(Vec3(size, 0, 0), Vec3(0.0), Vec3(size, size, 0))), 45, 1e-12);
    EXPECT_NEAR(value_of(angle_deg(Vec3(size, 0, 0), Vec3(0.0), Vec3(-size, 0, 0))), 180, 1e-12);
  }
  EXPECT_NEAR(value_of(angle_deg(Vec3(1, 0, 0), Vec3(0.0), Vec3(1, 1e-12, 0))), 1e-12 * 180 / 3.14159265358979, 1e-20);
  EXPECT_FALSE(angle_deg(Vec3(1.0), Vec3(1.0), Vec3(2.0)).has_value());
}

}  // namespace catena::field::measure_test
