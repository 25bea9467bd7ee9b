/// Small geometry of the widgets. Lengths in world units. + - * / and square roots only, so that bits repeat. Any thread; allocates
/// nothing.
#pragma once
#include "engine/base/rotation.h"

namespace catena::widget {

/// Axis i of the frame q, world: unit.
inline Vec3 axis_of(const Quat& q, int i) noexcept { return rotate(q, i == 0 ? Vec3(1, 0, 0) : i == 1 ? Vec3(0, 1, 0) : Vec3(0, 0, 1)); }

/// u beyond -zone..zone, 0 within: continuous, and one to one beyond.
inline double deadzone(double u, double zone) noexcept { return u > zone ? u - zone : u < -zone ? u + zone : 0; }

/// v without its part along the unit vector n, unit; zero where nothing is left.
inline Vec3 direction_across(const Vec3& v, const Vec3& n) noexcept {
  const Vec3 d = direction(v - n * dot(n, v));
  return direction(d - n * dot(n, d));
}

/// The rotation about the unit axis e that turns a onto b, both unit and square to e. Its vector part is a multiple of e to the bit.
///   cos(t/2) = |a + b| / 2,  sin(t/2) = |b - a| / 2, with the sign of e . (a x b)
inline Quat turn_about(const Vec3& e, const Vec3& a, const Vec3& b) noexcept {
  const double c = 0.5 * norm(a + b), s = dot(e, cross(a, b)) < 0 ? -0.5 * norm(b - a) : 0.5 * norm(b - a);
  const double length = std::sqrt(c * c + s * s);
  if (!(length > 0)) return kNoRotation;
  return {c / length, e.x * (s / length), e.y * (s / length), e.z * (s / length)};
}

}  // namespace catena::widget
