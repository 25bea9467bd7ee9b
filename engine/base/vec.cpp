// SPDX-License-Identifier: MIT
#include "engine/base/vec.h"

namespace catena {

Quat normalized(const Quat& q) noexcept {
  const double m = std::fmax(max_abs({q.x, q.y, q.z}), std::fabs(q.w));
  if (!(m > 0) || !is_finite(q)) return kIdentityRotation;
  const Quat r(q.w / m, q.x / m, q.y / m, q.z / m);
  const double n = std::sqrt(r.w * r.w + r.x * r.x + r.y * r.y + r.z * r.z);
  return {r.w / n, r.x / n, r.y / n, r.z / n};
}

Vec3 rotate(const Quat& q, const Vec3& v) noexcept {
  const Vec3 u(q.x, q.y, q.z), t = cross(u, v) * 2.0;
  return v + t * q.w + cross(u, t);
}

Vec3 rotation_vector(const Quat& q) noexcept {
  const Vec3 u = q.w < 0 ? Vec3(-q.x, -q.y, -q.z) : Vec3(q.x, q.y, q.z);
  const double s = norm(u);
  if (!(s > 0)) return Vec3(0.0);
  return u * (2 * std::atan2(s, std::fabs(q.w)) / s);
}

Quat rotation_from_vector(const Vec3& v) noexcept {
  const double angle = norm(v);
  if (!(angle > 0) || !std::isfinite(angle)) return kIdentityRotation;
  const Vec3 u = direction(v) * std::sin(0.5 * angle);
  return {std::cos(0.5 * angle), u.x, u.y, u.z};
}

Quat shortest_arc(const Vec3& a, const Vec3& b) noexcept {
  // |a + b| and |a - b| are exact near both ends, and the axis is orthogonalized to a: the cancellation in a x b then does not matter
  const double c = 0.5 * norm(a + b), s = 0.5 * norm(b - a);
  if (!(s > 0)) return kIdentityRotation;
  Vec3 axis = cross(a, b);
  axis = direction(axis - a * dot(a, axis));
  axis = direction(axis - a * dot(a, axis));
  if (!(max_abs(axis) > 0)) {
    if (c > 0.5) return kIdentityRotation;
    const Vec3 other = std::fabs(a.x) <= std::fabs(a.y) && std::fabs(a.x) <= std::fabs(a.z) ? Vec3(1, 0, 0)
                       : std::fabs(a.y) <= std::fabs(a.z)                                   ? Vec3(0, 1, 0)
                                                                                            : Vec3(0, 0, 1);
    axis = direction(cross(a, other));
  }
  return normalized({c, axis.x * s, axis.y * s, axis.z * s});
}

}  // namespace catena
