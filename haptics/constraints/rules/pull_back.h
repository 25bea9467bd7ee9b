/// J^T f of the projections that constraints make: what a force f on the proxy is for the probe by virtual work, J = dp/dx. Of closest
/// points J is symmetric.
///   point 0;  line t t^T;  plane I - n n^T
///   curve     t t^T / m, m = 1 - kappa N . (x - p)
///   surface   (I - n n^T) (I + delta B)^-1 on the tangent plane, delta = n . (x - p), dn = B dp
/// m and the eigenvalues of I + delta B are taken as at least kLeastFactor: near a focal point J grows without bound. World units. Haptic
/// thread: no allocation, lock, throw.
#pragma once
#include "haptics/chain/constraint.h"
#include "haptics/constraints/isosurface/analytic.h"

namespace catena::haptics {

inline constexpr double kLeastFactor = 0.1;  ///< of m and of I + delta B

/// Of a flat primitive.
inline PulledBack pull_back(const Primitive& primitive, const Vec3& f) noexcept {
  switch (primitive.kind) {
    case Primitive::Kind::line:
      return {primitive.axis * dot(primitive.axis, f)};
    case Primitive::Kind::plane:
      return {f - primitive.axis * dot(primitive.axis, f)};
    case Primitive::Kind::point:
      break;
  }
  return {};
}

/// v / m, m bounded.
inline PulledBack divided(const Vec3& v, double m) noexcept {
  if (m >= kLeastFactor) return {v / m};
  return {v / kLeastFactor, m > 0 ? v / m - v / kLeastFactor : Vec3(0.0)};
}

/// Of a curve with the unit tangent t.
inline PulledBack pull_back_on_curve(const Vec3& t, double m, const Vec3& f) noexcept { return divided(t * dot(t, f), m); }

/// Of a surface with the unit normal n; `times` gives B v.
template <class Times>
PulledBack pull_back_on_surface(const Vec3& n, double delta, const Times& times, const Vec3& f) noexcept {
  Vec3 a, b;
  tangents(n, a, b);
  const Vec3 ba = times(a), bb = times(b);
  const double m11 = 1 + delta * dot(a, ba), m12 = 0.5 * delta * (dot(a, bb) + dot(b, ba)), m22 = 1 + delta * dot(b, bb);
  const auto solved = [&](double least) {
    double u1, u2;
    solve_tangent(m11, m12, m22, dot(a, f), dot(b, f), least, u1, u2);
    return a * u1 + b * u2;
  };
  const Vec3 force = solved(kLeastFactor);
  // both eigenvalues above the bound: nothing is left out
  const double rest = (m11 - kLeastFactor) * (m22 - kLeastFactor) - m12 * m12;
  const bool free = m11 >= kLeastFactor && m22 >= kLeastFactor && rest >= 0;
  return {force, free ? Vec3(0.0) : solved(1e-12) - force};
}

}  // namespace catena::haptics
