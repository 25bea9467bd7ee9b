// SPDX-License-Identifier: MIT
/// Threshold by value: lengths of line parts, areas of cut triangles and extinctions against closed forms.
#include "render/extract/threshold.h"

#include <gtest/gtest.h>

#include <cmath>

namespace catena::render::threshold_test {

/// Sum of the part lengths along a line whose points are at 0, 1, 2, ...
double length_of(const std::vector<LinePart>& parts) {
  double length = 0;
  for (const LinePart& part : parts) length += part.last - part.first;
  return length;
}

TEST(Threshold, PartsOfALineEndWhereTheValueIsABound) {
  const std::vector<double> values{0, 4, 4, -4, NAN, 1, 2};
  const auto parts = line_parts_within(values, {{1, 3}});
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_DOUBLE_EQ(parts[0].first, 0.25);
  EXPECT_DOUBLE_EQ(parts[0].last, 0.75);
  EXPECT_DOUBLE_EQ(parts[1].first, 2.125);
  EXPECT_DOUBLE_EQ(parts[1].last, 2.375);
  EXPECT_DOUBLE_EQ(parts[2].first, 5);
  EXPECT_DOUBLE_EQ(parts[2].last, 6);
  EXPECT_EQ(entries_of<double>(parts[0], values), (std::vector<double>{1, 3}));
  // two tails: all but the middle
  EXPECT_DOUBLE_EQ(length_of(line_parts_within(std::vector<double>{-2, 2, 2}, {{-2, -1}, {1, 2}})), 0.25 + 0.25 + 1);
  EXPECT_EQ(line_parts_within(std::vector<double>{0, 0, 5}, {{0, 5}}).size(), 1u) << "a part that is not interrupted is one";
}

/// Area of the triangles, and the largest excess of a vertex's value over the bounds.
double area_of(const MeshGeometry& mesh) {
  double area = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    const Vec3 &a = mesh.vertices[mesh.triangles[i]], &b = mesh.vertices[mesh.triangles[i + 1]], &c = mesh.vertices[mesh.triangles[i + 2]];
    area += 0.5 * norm(cross(b - a, c - a));
  }
  return area;
}

TEST(Threshold, CutTrianglesCoverTheBandOfALinearValue) {
  // the value is x + 2 y on the unit square: within [a, b] it covers a band whose area has a closed form
  const auto below = [](double v) {  // area of x + 2 y < v in the unit square
    const auto corner = [](double t) { return t > 0 ? t * t / 4 : 0.0; };
    return corner(v) - corner(v - 1) - corner(v - 2) + corner(v - 3);
  };
  for (const auto& [lo, hi] : {std::pair{0.3, 0.9}, {-1.0, 0.4}, {2.2, 9.0}, {1.4, 1.4}, {-5.0, 5.0}, {4.0, 5.0}}) {
    MeshGeometry mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 3}, std::vector<Vec3>(4, Vec3(0, 0, 1))};
    std::vector<double> values{0, 1, 3, 2};
    cut_triangles(mesh, values, {{lo, hi}});
    EXPECT_NEAR(area_of(mesh), below(hi) - below(lo), 1e-12) << lo << " " << hi;
    ASSERT_EQ(mesh.vertices.size(), values.size());
    ASSERT_EQ(mesh.vertices.size(), mesh.normals.size());
    for (const std::uint32_t v : mesh.triangles) EXPECT_NEAR(mesh.vertices[v].x + 2 * mesh.vertices[v].y, values[v], 1e-12);
  }
  MeshGeometry mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {0, 1, 2}};
  std::vector<double> values{-1, NAN, 1};
  cut_triangles(mesh, values, {{-9, 9}});
  EXPECT_TRUE(mesh.triangles.empty()) << "a triangle with a corner without a value";
}

TEST(Threshold, ExtinctionsAreUnchangedInsideAndZeroOutside) {
  const std::vector<std::array<double, 2>> rows{{0, 1}, {2, 5}, {10, 3}};
  const auto cut = cut_extinctions(rows, {{1, 2.5}, {4, 4}});
  for (const float v : {1.0f, 1.7f, 2.0f, 2.5f, 4.0f})
    EXPECT_NEAR(interpolate_piecewise(cut, v, 1), interpolate_piecewise(rows, v, 1), 1e-6) << v;
  for (const float v : {-3.0f, 0.0f, 0.999f, 2.501f, 3.0f, 3.999f, 4.001f, 20.0f}) EXPECT_EQ(interpolate_piecewise(cut, v, 1), 0) << v;
}

}  // namespace catena::render::threshold_test
