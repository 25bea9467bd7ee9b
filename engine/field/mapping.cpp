// SPDX-License-Identifier: MIT
#include "engine/field/mapping.h"

#include <glm/matrix.hpp>

namespace catena::field {

Mapping Mapping::from_linear(const Mat3& world_from_index, const Vec3& origin) {
  Mapping m;
  m.world_from_index_linear = world_from_index;
  m.origin = origin;
  // a diagonal matrix is inverted exactly: no rounding errors from cofactors
  const Mat3& j = world_from_index;
  const bool diagonal = j[0][1] == 0 && j[0][2] == 0 && j[1][0] == 0 && j[1][2] == 0 && j[2][0] == 0 && j[2][1] == 0;
  if (diagonal) {
    m.index_from_world_linear = Mat3(0.0);
    for (int a = 0; a < 3; ++a) m.index_from_world_linear[a][a] = 1 / j[a][a];
  } else {
    m.index_from_world_linear = glm::inverse(j);
  }
  return m;
}

double Mapping::min_voxel_edge() const {
  const Mat3& j = world_from_index_linear;
  return std::min(std::min(norm(j[0]), norm(j[1])), norm(j[2]));
}

bool Mapping::is_invertible() const {
  return is_finite(origin) && is_finite(index_from_world(Vec3(1.0))) && min_voxel_edge() > 0 && is_finite(world_from_index(Vec3(1.0)));
}

Vec3 world_corner(const Mapping& mapping, const Box& box, int i) { return mapping.world_from_index(Bounds{box.lo, box.hi}.corner(i)); }

Bounds world_bounds(const Mapping& mapping, const Box& box) {
  Bounds bounds;
  for (int i = 0; i < 8; ++i) bounds.extend(world_corner(mapping, box, i));
  return bounds;
}

}  // namespace catena::field
