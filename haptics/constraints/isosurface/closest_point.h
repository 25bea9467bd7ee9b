// SPDX-License-Identifier: MIT
/// The closest point of a smooth level set to the probe x, one field sample per iteration.
///   n = grad s / |grad s|, l = (s - level) / |grad s|, e = x - p, delta = n.e, t = e - delta n
///   (I + delta B) u = t on the tangent plane (|eigenvalues| >= 0.1, less after 12 steps), |u| <= D;  p+ = p + u + (-l - u'Bu / 2) n
/// B, the surface's curvature, is SR1-updated from step to step and from tick to tick; after three rejected steps it is computed by finite
/// differences with two more samples.
/// Accepted: n.n+ > 0.3 and (Armijo on |e + l n|^2 / 2 + l^2 / 2, or |l| halved), else u *= 0.35. Haptic thread.
#pragma once
#include "haptics/constraints/common/pull_back.h"
#include "haptics/constraints/isosurface/level_set_field.h"

namespace catena::haptics {

/// Curvature of a level set: a symmetric matrix B with dn = B dp. Zero bytes: flat.
struct Curvature {
  double xx = 0, yy = 0, zz = 0, yz = 0, xz = 0, xy = 0;
  Vec3 times(const Vec3& v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
};

/// Convergence criteria and limits of the iteration.
struct ClosestPointCriteria {
  double tangential_tolerance = 0;  ///< bound of |t|, world units
  double level_tolerance = 0;       ///< bound of |l|, world units
  int max_fetches = 128;            ///< maximum number of field samples
  int max_rejections = 24;          ///< maximum number of rejected steps in a row; then stuck
};

/// Result of the iteration: converged, no descent step found, out of budget.
enum class ClosestPointResult { converged, stuck, out_of_budget };

/// Moves `at` (valid, not a plateau) to the closest point; `at` is the best point found whatever the result.
ClosestPointResult closest_point(LevelSetField& field, const Vec3& probe, const ClosestPointCriteria& goal, LevelPoint& at,
                                 Curvature& curvature) noexcept;

/// Makes the SR1 update of b from one accepted step, on the tangent plane of its end.
void update_curvature(const LevelPoint& from, const LevelPoint& to, double length, Curvature& b) noexcept;

/// Returns the finite-difference curvature at a point, with two more field samples, where SR1 updates converge too slowly.
Curvature measure_curvature(LevelSetField& field, const LevelPoint& at) noexcept;

/// Solves M u = t in two dimensions, with the eigenvalues of M taken as max(|.|, min_size): always a descent direction.
void solve_tangent(double m11, double m12, double m22, double t1, double t2, double min_size, double& u1, double& u2) noexcept;

/// Returns J^T f of the closest point of a surface with the unit normal n (common/pull_back.h); `times(v)` returns B v.
template <class Times>
PulledBackForce pull_back_on_surface(const Vec3& n, double delta, const Times& times, const Vec3& f) noexcept {
  Vec3 a, b;
  make_tangent_basis(n, a, b);
  const Vec3 ba = times(a), bb = times(b);
  const double m11 = 1 + delta * dot(a, ba), m12 = 0.5 * delta * (dot(a, bb) + dot(b, ba)), m22 = 1 + delta * dot(b, bb);
  const auto solved = [&](double min_size) {
    double u1, u2;
    solve_tangent(m11, m12, m22, dot(a, f), dot(b, f), min_size, u1, u2);
    return a * u1 + b * u2;
  };
  const Vec3 force = solved(kMinFactor);
  // both eigenvalues above the bound: nothing is truncated
  const double rest = (m11 - kMinFactor) * (m22 - kMinFactor) - m12 * m12;
  const bool free = m11 >= kMinFactor && m22 >= kMinFactor && rest >= 0;
  return {force, free ? Vec3(0.0) : solved(1e-12) - force};
}

}  // namespace catena::haptics
