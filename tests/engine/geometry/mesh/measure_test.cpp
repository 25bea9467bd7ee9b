// SPDX-License-Identifier: MIT
/// Area and volume of isosurfaces, parts and labels against closed forms at three resolutions.
#include "engine/geometry/mesh/measure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "engine/field/derived/label_surface.h"
#include "engine/field/measure/labels.h"
#include "engine/geometry/mesh/isosurface.h"
#include "tests/engine/field/field_helpers.h"

namespace catena::mesh::measure_test {

using field::Index3;
using field::Mapping;
using field::test::value_of;
using std::numbers::pi;

/// Mappings of `n` voxels per axis that cover a cube, a box of unequal voxels, and an oblique parallelepiped; all contain the ball of
/// radius 1 at kCenter, which is a voxel center.
const Vec3 kCenter(3.1, -2.2, 0.7);
Mapping centered(const Mat3& axes, int n) {
  const Mat3 linear = axes * (1.0 / n);
  return Mapping::from_linear(linear, kCenter - linear * Vec3(n / 2));
}
std::vector<Mapping> mappings(int n) {
  const Mat3 turn(Vec3(0.8, 0.6, 0.0), Vec3(-0.6, 0.8, 0.0), Vec3(0.0, 0.0, 1.0));
  return {centered(Mat3(3.0), n), centered(turn * Mat3(3, 0, 0, 0, 4.5, 0, 0, 0, 3.4), n),
          centered(Mat3(3.2, 0.4, 0.1, -1.2, 3.6, 0.3, 0.5, -0.3, -3.1), n)};
}

template <class F>
std::shared_ptr<const field::ScalarGrid> sampled(const Mapping& mapping, int n, const F& f, const std::vector<std::uint8_t>& valid = {}) {
  const Index3 size{n + 1, n + 1, n + 1};
  return field::make_scalar_grid(
      "g", mapping, size,
      field::test::values_of(size, [&](int x, int y, int z) { return f(mapping.world_from_index(Vec3(x, y, z)) - kCenter); }), valid);
}

double ball(const Vec3& p) { return 1 - norm(p); }
double torus(const Vec3& p) { return 0.4 - std::hypot(std::hypot(p.x, p.y) - 0.8, p.z); }
double box(const Vec3& p) { return 1 - std::max({std::fabs(p.x) / 0.9, std::fabs(p.y) / 0.6, std::fabs(p.z) / 0.5}); }

SurfaceMeasure measured(const field::ScalarGrid& grid, double level = 0) {
  return measure_surface(value_of(extract_isosurface(grid, level, OutwardSide::lower, "grid")));
}

/// Expects errors that fall with the square of the voxel edge.
void expect_second_order(const std::vector<double>& errors, const std::string& what) {
  for (std::size_t k = 1; k < errors.size(); ++k) {
    const double order = std::log2(std::fabs(errors[k - 1] / errors[k]));
    EXPECT_GT(order, 1.75) << what;
    EXPECT_LT(order, 2.35) << what;
  }
  std::printf("%s: relative errors %.3g %.3g %.3g, orders %.2f %.2f\n", what.c_str(), errors[0], errors[1], errors[2],
              std::log2(std::fabs(errors[0] / errors[1])), std::log2(std::fabs(errors[1] / errors[2])));
}

TEST(MeasureSurface, BallAndTorusConvergeWithTheSquareOfTheVoxelEdge) {
  struct Shape {
    const char* name;
    double (*f)(const Vec3&);
    double area, volume;
  };
  for (const Shape& shape : {Shape{"ball", ball, 4 * pi, 4 * pi / 3}, {"torus", torus, 4 * pi * pi * 0.8 * 0.4, 2 * pi * pi * 0.8 * 0.16}})
    for (std::size_t m = 0; m < 3; ++m) {
      std::vector<double> areas, volumes;
      for (const int n : {24, 48, 96}) {
        const SurfaceMeasure surface = measured(*sampled(mappings(n)[m], n, shape.f));
        ASSERT_TRUE(surface.volume.has_value());
        EXPECT_EQ(surface.open_edges, 0u);
        EXPECT_FALSE(surface.encloses_lower);
        areas.push_back(surface.area / shape.area - 1);
        volumes.push_back(*surface.volume / shape.volume - 1);
      }
      expect_second_order(areas, shape.name + std::string(" area ") + std::to_string(m));
      expect_second_order(volumes, shape.name + std::string(" volume ") + std::to_string(m));
    }
}

TEST(MeasureSurface, ABoxLosesOnlyItsEdges) {
  for (std::size_t m = 0; m < 3; ++m)
    for (const int n : {24, 48, 96}) {
      const SurfaceMeasure surface = measured(*sampled(mappings(n)[m], n, box));
      const double h = 4.5 / n, area = 8 * (0.9 * 0.6 + 0.9 * 0.5 + 0.6 * 0.5), edges = 8 * (0.9 + 0.6 + 0.5);
      EXPECT_LT(surface.area, area);
      EXPECT_GT(surface.area, area - edges * h);
      EXPECT_NEAR(*surface.volume, 8 * 0.9 * 0.6 * 0.5, edges * h * h / 2);
    }
}

TEST(MeasureSurface, AMaskAtTheCenterLeavesAnOpenHemisphere) {
  for (std::size_t m = 0; m < 3; ++m) {
    std::vector<double> errors;
    for (const int n : {24, 48, 96}) {
      const Index3 size{n + 1, n + 1, n + 1};
      const auto valid = field::test::values_of<std::uint8_t>(size, [&](int x, int, int) { return x <= n / 2; });
      const auto grid = sampled(mappings(n)[m], n, ball, valid);
      const SurfaceMeasure surface = measured(*grid);
      EXPECT_FALSE(surface.volume.has_value());
      EXPECT_GT(surface.open_edges, 20u);
      errors.push_back(surface.area / (2 * pi) - 1);
      const auto parts = value_of(field::measure_parts(*grid, 0, field::Neighbors::all, 5, nullptr));
      EXPECT_FALSE(value_of(measure_isosurface(*grid, 0, parts, "g")).parts[0].is_closed);
    }
    expect_second_order(errors, "hemisphere area " + std::to_string(m));
  }
}

TEST(MeasureSurface, ADistanceEnclosesLowerValuesAndABallAtTheBorderIsOpen) {
  const auto grid = sampled(mappings(32)[0], 32, [](const Vec3& p) { return norm(p); });
  const SurfaceMeasure inner = measured(*grid, 1), cut = measured(*grid, 1.7);
  EXPECT_TRUE(inner.encloses_lower);
  EXPECT_NEAR(value_of(inner.volume), 4 * pi / 3, 0.03);
  EXPECT_FALSE(cut.volume.has_value());
}

TEST(MeasureParts, TwoBallsHaveTheirOwnSurfaces) {
  const double first = 0.6, second = 0.35;
  for (std::size_t m = 0; m < 3; ++m) {
    const int n = 96;
    const auto grid = sampled(mappings(n)[m], n, [&](const Vec3& p) {
      return std::max(first - norm(p - Vec3(-0.4, 0, 0)), second - norm(p - Vec3(0.75, 0.1, 0)));
    });
    for (const auto neighbors : {field::Neighbors::faces, field::Neighbors::all}) {
      const auto parts = value_of(field::measure_parts(*grid, 0, neighbors, 5, nullptr));
      ASSERT_EQ(parts.count, 2u);
      const auto surfaces = value_of(measure_isosurface(*grid, 0, parts, "g")).parts;
      EXPECT_NEAR(surfaces[0].area, 4 * pi * first * first, 0.005 * 4 * pi * first * first);
      EXPECT_NEAR(surfaces[1].area, 4 * pi * second * second, 0.01 * 4 * pi * second * second);
      EXPECT_EQ(surfaces[2].area, 0);
      EXPECT_TRUE(surfaces[0].is_closed && surfaces[1].is_closed);
      EXPECT_LT(norm(parts.parts[1].centroid(grid->mapping()) - kCenter - Vec3(0.75, 0.1, 0)), 0.01);
      const auto kept = value_of(field::measure_parts(*grid, 0, neighbors, 1, nullptr));
      EXPECT_EQ(value_of(measure_isosurface(*grid, 0, kept, "g")).parts[1].area, surfaces[1].area);
    }
  }
}

/// Whether each part is closed: no triangle of it has an edge without its opposite.
std::vector<bool> closed_parts(const Isosurface& surface, const Mapping& mapping, const field::MeasuredParts& parts) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> net;
  for (const Triangle& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++net[{t[k], t[(k + 1) % 3]}], --net[{t[(k + 1) % 3], t[k]}];
  std::vector<bool> closed(parts.parts.size() + 1, true);
  for (const Triangle& t : surface.triangles) {
    std::optional<std::uint32_t> part;
    for (std::size_t k = 0; k < 3 && !part; ++k) {
      const Vec3 at = mapping.index_from_world(surface.vertices[t[k]]);
      for (const double toward : {-0.4999999, 0.4999999})  // the two voxels of the edge
        if (!part)
          part = parts.map.part_at({int(std::lround(at.x + toward)), int(std::lround(at.y + toward)), int(std::lround(at.z + toward))});
    }
    for (std::size_t k = 0; k < 3; ++k)
      if (net[{t[k], t[(k + 1) % 3]}] != 0) closed[part.value_or(parts.parts.size())] = false;
  }
  return closed;
}

/// Noise whose values are often exactly the level, in a box that begins beside a block, with a mask.
TEST(MeasureIsosurface, EqualsTheStoredSurfaceBitForBit) {
  const Index3 n{21, 18, 27};
  for (const double masked : {0.0, 0.02}) {
    field::test::Random random(9);
    const auto values = field::test::values_of(n, [&](int x, int y, int z) {
      const bool inside = x > 1 && y > 1 && z > 1 && x < n.x - 2 && y < n.y - 2 && z < n.z - 2;
      return inside ? std::floor(random.uniform(-1.2, 1.9)) + (x % 3 == 0 ? random.uniform(0, 0.4) : 0) : -1.0;
    });
    const auto valid = field::test::values_of<std::uint8_t>(n, [&](int, int, int) { return random.uniform(0, 1) >= masked; });
    const Mapping mapping = centered(Mat3(3.2, 0.4, 0.1, -1.2, 3.6, 0.3, 0.5, -0.3, -3.1), 20);
    const auto grid = field::make_scalar_grid("g", mapping, n, values, valid);
    for (const double level : {0.0, 0.3}) {
      const Isosurface stored = value_of(extract_isosurface(*grid, level, OutwardSide::lower, "g"));
      const SurfaceMeasure whole = measure_surface(stored);
      const auto parts = value_of(field::measure_parts(*grid, level, field::Neighbors::all, 40, nullptr));
      const SurfaceMeasure blocks = value_of(measure_isosurface(*grid, level, parts, "g"));
      EXPECT_EQ(blocks.area, whole.area);
      EXPECT_EQ(blocks.open_edges, whole.open_edges);
      EXPECT_EQ(blocks.open_edges > 0, masked > 0);
      EXPECT_EQ(blocks.volume, whole.volume);
      EXPECT_EQ(blocks.encloses_lower, whole.encloses_lower);
      std::uint64_t triangles = 0;
      const std::vector<bool> closed = closed_parts(stored, mapping, parts);
      ASSERT_EQ(blocks.parts.size(), closed.size());
      for (std::size_t p = 0; p < closed.size(); ++p) {
        triangles += blocks.parts[p].triangles;
        EXPECT_EQ(blocks.parts[p].is_closed, closed[p]) << p;
      }
      EXPECT_EQ(triangles, stored.triangles.size());
    }
  }
}

TEST(MeasureIsosurface, ALevelWithoutASurfaceIsAnError) {
  const auto grid = sampled(mappings(8)[0], 8, [](const Vec3&) { return 2.0; });
  const auto parts = value_of(field::measure_parts(*grid, 1, field::Neighbors::all, 1, nullptr));
  const auto measured = measure_isosurface(*grid, 1, parts, "the isosurface");
  ASSERT_FALSE(measured);
  EXPECT_EQ(measured.error().message, extract_isosurface(*grid, 1, OutwardSide::lower, "the isosurface").error().message);
}

TEST(MeasureLabels, SurfacesEqualTheIsosurfacesOfTheIndicator) {
  for (const Mapping& mapping : field::test::mappings()) {
    field::test::Random random(7);
    const Index3 n{11, 9, 21};
    const auto map = field::make_scalar_grid("m", mapping, n, field::test::values_of(n, [&](int x, int y, int z) {
                                               return std::floor(random.uniform(0, 2.5)) + (x + y + z > 18 ? 1 : 0);
                                             }));
    auto measured = value_of(field::measure_labels(*map, nullptr));
    ASSERT_TRUE(bool(field::add_label_surfaces(*map, label_cell_areas(mapping), measured)));
    const auto counts = value_of(field::count_labels(*map));
    ASSERT_EQ(measured.labels.size(), counts.size());
    for (const field::MeasuredLabel& label : measured.labels) {
      if (label.label == 0) continue;
      const auto chi = value_of(field::make_label_surface(*map, counts, {label.label}, 0, "label"));
      const double area = measure_surface(value_of(extract_isosurface(*chi, 0.5, OutwardSide::lower, "l"))).area;
      EXPECT_NEAR(label.surface, area, 2e-5 * area);  // of two equally long diagonals either may be chosen
    }
  }
}

TEST(MeasureLabels, TheSurfaceOfALabeledBallIsFiveToTenPercentTooLarge) {
  for (const int n : {24, 48, 96}) {
    const auto map = sampled(mappings(n)[0], n, [](const Vec3& p) { return norm(p) < 1 ? 4.0 : 0.0; });
    auto measured = value_of(field::measure_labels(*map, nullptr));
    ASSERT_TRUE(bool(field::add_label_surfaces(*map, label_cell_areas(map->mapping()), measured)));
    const double ratio = measured.labels.back().surface / (4 * pi);
    std::printf("labeled ball, %d voxels: area ratio %.4f, volume ratio %.5f\n", n, ratio,
                static_cast<double>(measured.labels.back().voxels) * field::voxel_volume(map->mapping()) / (4 * pi / 3));
    EXPECT_GT(ratio, 1.05);
    EXPECT_LT(ratio, 1.10);
  }
}

}  // namespace catena::mesh::measure_test
