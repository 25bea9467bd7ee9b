/// Safe normalisation (the sigma of the paper's Eq. 9): an absolute eps would break under a change of units.
///   m = max|v_i|; not 0 < m < inf: direction 0, factor 0.   w = v / m, r = |w|, d = w / r, q = min((m / X) r, 1e3),
///   factor = q^2 / (q^2 + 1e-12), X the field's largest magnitude (engine/field/magnitude.h); X = 0 gives 0.
/// Any thread.
#pragma once
#include "engine/base/vec.h"

namespace catena::haptics {

struct SafeDirection {
  Vec3 d{0.0};
  double factor = 0;  ///< 1, but 0 where the field is ill-defined
};

/// `normal` (unit, or zero): only what is tangential to it counts, v - (v.n) n.
inline SafeDirection safe_direction(const Vec3& v, double largest, const Vec3& normal = Vec3(0.0)) noexcept {
  const double m = max_abs(v);
  if (!(m > 0) || !is_finite(v) || !(largest > 0)) return {};
  Vec3 w = m > 1e-300 ? v * (1 / m) : Vec3(v.x / m, v.y / m, v.z / m);
  w = w - normal * dot(w, normal);
  const double r = std::sqrt(dot(w, w));
  if (!(r > 0)) return {};
  const double q = std::min(m / largest * r, 1e3);
  return {w * (1 / r), q * q / (q * q + 1e-12)};
}

}  // namespace catena::haptics
