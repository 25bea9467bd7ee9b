// SPDX-License-Identifier: MIT
/// Mesh links, and brute-force references: the closest point over all triangles, and inside by ray crossings.
#pragma once
#include "tests/haptics/constraints/constraint_fixture.h"
#include "tests/support/mesh_shapes.h"

namespace catena::haptics::tests {

using catena::test::add_box;
using catena::test::add_quad;
using catena::test::box_soup;
using catena::test::make_mesh_from;
using catena::test::sheet_soup;
using catena::test::sphere_soup;

inline ConstraintPtr mesh_link(mesh::MeshPtr mesh, const std::string& more = R"(, "free": "above")") {
  Fields fields;
  fields.meshes["m"] = std::move(mesh);
  return build(R"({"name": "a", "type": "mesh", "mesh": "m")" + more + "}", fields);
}

/// The closest point of one triangle, over its plane, its edges and its corners.
inline Vec3 closest_on_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& x) {
  const Vec3 n = cross(b - a, c - a);
  const Vec3 p = x - n * (dot(n, x - a) / dot(n, n));
  if (dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 && dot(cross(a - c, p - c), n) >= 0) return p;
  Vec3 best = a;
  for (const auto& [u, v] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    const double t = std::clamp(dot(x - u, v - u) / dot(v - u, v - u), 0.0, 1.0);
    const Vec3 q = u + t * (v - u);
    if (norm(q - x) < norm(best - x)) best = q;
  }
  return best;
}

inline Vec3 closest_on_mesh(const mesh::TriangleMesh& mesh, const Vec3& x) {
  Vec3 best(1e300);
  for (const mesh::Triangle& t : mesh.triangles()) {
    const Vec3 p = closest_on_triangle(mesh.vertices()[t[0]], mesh.vertices()[t[1]], mesh.vertices()[t[2]], x);
    if (norm(p - x) < norm(best - x)) best = p;
  }
  return best;
}

/// True inside a closed mesh, by the parity of the crossings of a ray in a generic direction.
inline bool is_inside(const mesh::TriangleMesh& mesh, const Vec3& x) {
  const Vec3 way = direction(Vec3(0.5377, 0.8339, -0.2259));
  int crossings = 0;
  for (const mesh::Triangle& t : mesh.triangles()) {
    const Vec3 a = mesh.vertices()[t[0]] - x, b = mesh.vertices()[t[1]] - x, c = mesh.vertices()[t[2]] - x;
    const double u = dot(way, cross(a, b)), v = dot(way, cross(b, c)), w = dot(way, cross(c, a));
    const bool through = (u > 0) == (v > 0) && (v > 0) == (w > 0);
    if (through && (dot(a, cross(b, c)) > 0) == (u > 0)) ++crossings;
  }
  return crossings % 2 == 1;
}

inline double off(const mesh::TriangleMesh& mesh, const Vec3& p) { return norm(closest_on_mesh(mesh, p) - p) / mesh.domain_length(); }

}  // namespace catena::haptics::tests
