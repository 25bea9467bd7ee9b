// SPDX-License-Identifier: MIT
#include "engine/field/cell.h"

namespace catena::field {

Vec3 ScalarCell::mixed_second_derivatives(const Vec3& f) const {
  const auto& c = corner;
  // d2/dxdy at the lower and the upper z, and likewise for xz and yz: second differences over one face
  const double xy0 = (c[3] - c[2]) - (c[1] - c[0]), xy1 = (c[7] - c[6]) - (c[5] - c[4]);
  const double xz0 = (c[5] - c[4]) - (c[1] - c[0]), xz1 = (c[7] - c[6]) - (c[3] - c[2]);
  const double yz0 = (c[6] - c[4]) - (c[2] - c[0]), yz1 = (c[7] - c[5]) - (c[3] - c[1]);
  return Vec3(yz0 + (yz1 - yz0) * f.x, xz0 + (xz1 - xz0) * f.y, xy0 + (xy1 - xy0) * f.z);
}

}  // namespace catena::field
