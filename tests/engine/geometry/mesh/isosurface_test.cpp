// SPDX-License-Identifier: MIT
#include "engine/geometry/mesh/isosurface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "engine/field/analytic/analytic.h"
#include "tests/engine/field/field_helpers.h"
#include "tests/support/results.h"

namespace catena::mesh::isosurface_test {

using field::Index3;
using field::test::Random;

/// The number of directed edges that occur more than once, and of those without their opposite.
struct EdgeCount {
  int repeated = 0, open = 0;
};
EdgeCount edges_of(const Isosurface& s) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
  for (const Triangle& t : s.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++count[{t[k], t[(k + 1) % 3]}];
  EdgeCount edges;
  for (const auto& [edge, n] : count) {
    edges.repeated += n > 1;
    edges.open += !count.contains({edge.second, edge.first});
  }
  return edges;
}

double volume_of(const Isosurface& s) {
  double volume = 0;
  for (const Triangle& t : s.triangles) volume += dot(s.vertices[t[0]], cross(s.vertices[t[1]], s.vertices[t[2]])) / 6;
  return volume;
}

Isosurface made(const field::ScalarGrid& grid, double level, OutwardSide outside = OutwardSide::lower) {
  return field::test::value_of(extract_isosurface(grid, level, outside, "grid"));
}

/// Noise that is below the level on all faces of the grid.
std::vector<float> noise(const Index3& n, std::uint64_t seed, bool whole_numbers) {
  Random random(seed);
  return field::test::values_of(n, [&](int x, int y, int z) {
    const bool rim = x == 0 || y == 0 || z == 0 || x == n.x - 1 || y == n.y - 1 || z == n.z - 1;
    const double v = random.uniform(-3, 4);
    return rim ? -3 : whole_numbers ? std::round(v) : v;
  });
}

TEST(Isosurface, NoiseHasAClosedSurfaceWithVerticesOnEdgesForAnyMapping) {
  const Index3 n{19, 12, 10};
  std::uint64_t seed = 1;
  for (const field::Mapping& mapping : field::test::mappings()) {
    const auto grid = field::make_scalar_grid("n", mapping, n, noise(n, ++seed, false));
    const double level = 0.3;
    const Isosurface s = made(*grid, level);
    const EdgeCount edges = edges_of(s);
    EXPECT_EQ(edges.repeated, 0);
    EXPECT_EQ(edges.open, 0);
    ASSERT_EQ(s.normals.size(), s.vertices.size());
    field::Cursor cursor;
    int within = 0;
    for (std::size_t i = 0; i < s.vertices.size(); ++i) {
      EXPECT_NEAR(grid->sample(s.vertices[i], cursor).value, level, 1e-12);
      const Vec3 index = mapping.index_from_world(s.vertices[i]);
      int whole = 0;
      for (int a = 0; a < 3; ++a) whole += std::fabs(index[a] - std::round(index[a])) < 1e-12;
      within += whole < 2;
      EXPECT_NEAR(norm(s.normals[i]), 1, 1e-12);
    }
    EXPECT_LT(within, static_cast<int>(s.vertices.size() / 50)) << "on the edges of cells, but for a few";
    // Values above the level are inside.
    EXPECT_GT(volume_of(s), 0);
    EXPECT_NEAR(volume_of(made(*grid, level, OutwardSide::higher)), -volume_of(s), 1e-9 * volume_of(s));
  }
}

TEST(Isosurface, LargeNoiseHasNoRepeatedEdge) {
  const Index3 n{25, 25, 25};
  for (std::uint64_t seed = 100; seed < 110; ++seed) {
    const EdgeCount edges = edges_of(made(*field::make_scalar_grid("n", {}, n, noise(n, seed, false)), 0.5));
    EXPECT_EQ(edges.repeated, 0) << seed;
    EXPECT_EQ(edges.open, 0) << seed;
  }
}

TEST(Isosurface, VoxelsAtTheLevelGiveNoDegenerateTriangles) {
  const Index3 n{14, 14, 14};
  const Isosurface s = made(*field::make_scalar_grid("n", {}, n, noise(n, 7, true)), 1);
  EXPECT_EQ(edges_of(s).open, 0);
  for (const Triangle& t : s.triangles) EXPECT_TRUE(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
  std::map<std::array<double, 3>, int> places;
  for (const Vec3& v : s.vertices) EXPECT_EQ(++places[(std::array<double, 3>{v.x, v.y, v.z})], 1) << "one vertex a corner";
}

TEST(Isosurface, ASphereHasItsVolumeAndNormals) {
  const auto formula = field::make_analytic("sphere");
  const auto grid = field::sample_on_grid(*formula->scalar, 65, -2, 2);
  // The values are distances from the center, so higher values are outside.
  const Isosurface s = made(*grid, 1, OutwardSide::higher);
  EXPECT_EQ(edges_of(s).open, 0);
  EXPECT_NEAR(volume_of(s), 4.18879, 0.01);
  for (std::size_t i = 0; i < s.vertices.size(); ++i) {
    EXPECT_NEAR(norm(s.vertices[i]), 1, 1e-3);
    EXPECT_GT(dot(s.normals[i], direction(s.vertices[i])), 0.999);
  }
}

/// s = x: the plane x = 3.5 has as many squares as there are valid cells.
TEST(Isosurface, LeavesOutInvalidCells) {
  const Index3 n{12, 11, 10};
  std::vector<float> values;
  std::vector<std::uint8_t> valid;
  for (int i = 0; i < n.x * n.y * n.z; ++i) {
    values.push_back(static_cast<float>(i % n.x));
    valid.push_back(i % n.x == 3 && i / n.x % n.y == 5 && i / (n.x * n.y) == 5 ? 0 : 1);
  }
  const Isosurface whole = made(*field::make_scalar_grid("x", {}, n, values), 3.5);
  EXPECT_EQ(whole.triangles.size(), 2u * 10 * 9);
  const Isosurface masked = made(*field::make_scalar_grid("x", {}, n, values, valid), 3.5);
  EXPECT_EQ(masked.triangles.size(), 2u * (10 * 9 - 4));
  values[3 + 12 * (5 + 11 * 5)] = std::numeric_limits<float>::quiet_NaN();
  const Isosurface holed = made(*field::make_scalar_grid("x", {}, n, values), 3.5);
  EXPECT_EQ(holed.triangles.size(), masked.triangles.size());
  for (const Vec3& normal : holed.normals) EXPECT_EQ(normal, Vec3(-1, 0, 0));
}

TEST(Isosurface, RefusesFieldsWithoutASurface) {
  const std::vector<float> values{0, 1, 2, 3};
  const auto flat = extract_isosurface(*field::make_scalar_grid("x", {}, {2, 2, 1}, values), 1.5, OutwardSide::lower, "flat");
  EXPECT_TRUE(test::fails(flat, "single layer"));
  const auto none =
      extract_isosurface(*field::make_scalar_grid("x", {}, {2, 2, 2}, std::vector<float>(8, 1.f)), 1, OutwardSide::lower, "one");
  EXPECT_TRUE(test::fails(none, "one: there is no surface at 1"));
}

}  // namespace catena::mesh::isosurface_test
