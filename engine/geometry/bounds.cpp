#include "engine/geometry/bounds.h"

#include <algorithm>

namespace catena {

void Bounds::add(const Vec3& p, double radius) {
  if (!is_finite(p)) return;
  for (int i = 0; i < 3; ++i) {
    lo[i] = std::min(lo[i], p[i] - radius);
    hi[i] = std::max(hi[i], p[i] + radius);
  }
}

void Bounds::add(const Bounds& other) {
  if (other.empty()) return;
  add(other.lo);
  add(other.hi);
}

}  // namespace catena
