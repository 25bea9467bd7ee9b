// SPDX-License-Identifier: MIT
#include "engine/base/bounds.h"

#include <algorithm>

namespace catena {

void Bounds::extend(const Vec3& p, double radius) {
  if (!is_finite(p)) return;
  for (int i = 0; i < 3; ++i) {
    lo[i] = std::min(lo[i], p[i] - radius);
    hi[i] = std::max(hi[i], p[i] + radius);
  }
}

void Bounds::extend(const Bounds& other) {
  if (other.empty()) return;
  extend(other.lo);
  extend(other.hi);
}

}  // namespace catena
