// SPDX-License-Identifier: MIT
/// Pull-back J^T f of a force f on the proxy to the probe, by virtual work, with the Jacobian J = dp/dx of the constraint's projection.
/// For closest-point projections J is symmetric.
///   point 0;  line t t^T;  plane I - n n^T
///   curve     t t^T / m, m = 1 - kappa N . (x - p)
///   surface   (I - n n^T) (I + delta B)^-1 on the tangent plane, delta = n . (x - p), dn = B dp (isosurface/closest_point.h)
/// m and the eigenvalues of I + delta B are bounded below by kMinFactor: near a focal point J grows without bound. World units.
/// Haptic thread: no allocation, lock, throw.
#pragma once
#include "haptics/chain/constraint.h"

namespace catena::haptics {

inline constexpr double kMinFactor = 0.1;  ///< lower bound of m and of the eigenvalues of I + delta B

/// Returns J^T f of a point, line or plane primitive.
inline PulledBackForce pull_back(const Primitive& primitive, const Vec3& f) noexcept {
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

/// Returns v / m with m bounded below by kMinFactor; `truncated` is the rest of the unbounded v / m, and zero where m <= 0.
inline PulledBackForce divide_bounded(const Vec3& v, double m) noexcept {
  if (m >= kMinFactor) return {v / m};
  return {v / kMinFactor, m > 0 ? v / m - v / kMinFactor : Vec3(0.0)};
}

/// Returns J^T f of a curve with the unit tangent t.
inline PulledBackForce pull_back_on_curve(const Vec3& t, double m, const Vec3& f) noexcept { return divide_bounded(t * dot(t, f), m); }

}  // namespace catena::haptics
