// SPDX-License-Identifier: MIT
/// Terms of the sums for area and volume (measure.h).
#pragma once
#include <vector>

#include "engine/geometry/mesh/mesh.h"

namespace catena::mesh {

inline double area_of(const std::vector<Vec3>& vertices, const Triangle& t) {
  const Vec3& a = vertices[t[0]];
  return norm(cross(vertices[t[1]] - a, vertices[t[2]] - a)) / 2;
}

/// Signed volume of the tetrahedron between a triangle and `origin`.
inline double volume_of(const std::vector<Vec3>& vertices, const Triangle& t, const Vec3& origin) {
  return dot(vertices[t[0]] - origin, cross(vertices[t[1]] - origin, vertices[t[2]] - origin)) / 6;
}

}  // namespace catena::mesh
