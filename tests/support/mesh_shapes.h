// SPDX-License-Identifier: MIT
/// Meshes with known closest points: box, sphere, sheet, plate, wedge, and their files.
#pragma once
#include <cmath>
#include <cstring>
#include <string>

#include "engine/geometry/mesh/mesh.h"

namespace catena::test {

inline void add_quad(mesh::TriangleSoup& soup, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto first = static_cast<std::uint32_t>(soup.vertices.size());
  soup.vertices.insert(soup.vertices.end(), {a, b, c, d});
  soup.triangles.push_back({first, first + 1, first + 2});
  soup.triangles.push_back({first, first + 2, first + 3});
}

/// A box with outward normals.
inline void add_box(mesh::TriangleSoup& soup, const Vec3& lo, const Vec3& hi) {
  const auto at = [&](int x, int y, int z) { return Vec3(x ? hi.x : lo.x, y ? hi.y : lo.y, z ? hi.z : lo.z); };
  add_quad(soup, at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0));
  add_quad(soup, at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1));
  add_quad(soup, at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1));
  add_quad(soup, at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0));
  add_quad(soup, at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0));
  add_quad(soup, at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1));
}

inline mesh::TriangleSoup box_soup(const Vec3& lo = Vec3(-0.5), const Vec3& hi = Vec3(0.5)) {
  mesh::TriangleSoup soup;
  add_box(soup, lo, hi);
  return soup;
}

/// z = height(x, y) on n x n squares of [-half, half]^2, with upward normals.
template <class F>
mesh::TriangleSoup sheet_soup(int n, double half, const F& height) {
  mesh::TriangleSoup soup;
  const auto at = [&](int i, int j) {
    const double x = half * (2.0 * i / n - 1), y = half * (2.0 * j / n - 1);
    return Vec3(x, y, height(x, y));
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) add_quad(soup, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  return soup;
}

/// An icosahedron with every face divided into n x n triangles, projected onto the sphere: 20 n^2 faces.
inline mesh::TriangleSoup sphere_soup(int n, double radius = 1, const Vec3& centre = Vec3(0.0)) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  const Vec3 v[12] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  const int f[20][3] = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                        {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                        {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  mesh::TriangleSoup soup;
  for (const auto& t : f) {
    // the weights are summed in a fixed order of the corners, so that neighbours are bit-identical
    const auto at = [&](int i, int j) {
      int weight[12] = {};
      weight[t[0]] += n - i - j;
      weight[t[1]] += i;
      weight[t[2]] += j;
      Vec3 p(0.0);
      for (int k = 0; k < 12; ++k)
        if (weight[k] != 0) p += static_cast<double>(weight[k]) * v[k];
      return centre + radius * direction(p);
    };
    const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
      const auto first = static_cast<std::uint32_t>(soup.vertices.size());
      soup.vertices.insert(soup.vertices.end(), {a, b, c});
      soup.triangles.push_back({first, first + 1, first + 2});
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        add(at(i, j), at(i + 1, j), at(i, j + 1));
        if (i + j + 1 < n) add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
  }
  return soup;
}

inline mesh::MeshPtr make_mesh_from(mesh::TriangleSoup soup, const std::string& name = "made") {
  auto made = mesh::make_mesh(std::move(soup), name);
  CATENA_ASSERT(static_cast<bool>(made));
  return *made;
}

inline std::string binary_stl(const mesh::TriangleSoup& soup) {
  std::string out(80, ' ');
  const auto add = [&](const auto& value) { out.append(reinterpret_cast<const char*>(&value), sizeof value); };
  add(static_cast<std::uint32_t>(soup.triangles.size()));
  for (const mesh::Triangle& t : soup.triangles) {
    for (int i = 0; i < 3; ++i) add(0.0f);
    for (const std::uint32_t v : t)
      for (int i = 0; i < 3; ++i) add(static_cast<float>(soup.vertices[v][i]));
    add(std::uint16_t{0});
  }
  return out;
}

inline std::string text_stl(const mesh::TriangleSoup& soup) {
  std::string out = "solid made\n";
  const auto number = [](double v) {
    char text[40];
    std::snprintf(text, sizeof text, " %.17g", v);
    return std::string(text);
  };
  for (const mesh::Triangle& t : soup.triangles) {
    out += " facet normal 0 0 0\n  outer loop\n";
    for (const std::uint32_t v : t)
      out += "   vertex" + number(soup.vertices[v].x) + number(soup.vertices[v].y) + number(soup.vertices[v].z) + "\n";
    out += "  endloop\n endfacet\n";
  }
  return out + "endsolid made\n";
}

}  // namespace catena::test
