/// A straight piece a..b, the part of `segment` and `polyline`: the foot of the perpendicular, clamped to the ends.
///   s = d . (x - a);  foot = a where s <= 0, b where s >= |b - a| (both bit for bit), else a + s d
/// Finite for |x| up to 1e300. Lengths in world units. Any thread; allocates nothing.
#pragma once
#include "engine/base/vec.h"

namespace catena::haptics {

struct Straight {
  Vec3 a{0.0}, b{0.0};
  Vec3 d{0.0};        ///< unit
  double length = 0;  ///< finite and > 0, or the piece is not usable

  Straight() = default;
  Straight(const Vec3& from, const Vec3& to) : a(from), b(to), d(direction(to - from)), length(norm(to - from)) {}
  bool usable() const noexcept { return length > 0 && std::isfinite(length) && max_abs(d) > 0; }

  double along(const Vec3& x) const noexcept { return dot(d, x - a); }
  int end_of(double s) const noexcept { return s <= 0 ? -1 : s >= length ? 1 : 0; }  ///< -1: a, 1: b, 0: between
  Vec3 at(double s) const noexcept { return s <= 0 ? a : s >= length ? b : a + d * s; }
  double off_axis(const Vec3& p) const noexcept {
    const Vec3 away = p - a;
    return norm(away - d * dot(d, away));
  }
};

}  // namespace catena::haptics
