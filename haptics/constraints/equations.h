// SPDX-License-Identifier: MIT
/// The equations of the paper's sections 4 and 6.1, each under its number and in its symbols. The constraints move their proxies by these
/// equations and add their own safeguards. (Eqs. 3 and 4 are steps of an integrator: engine/geometry/flow/runge_kutta.h.)
///   x the probe, p the proxy, v the vector field, s the scalar field, s_0 its level, t = v / |v|, n = grad s / |grad s|
/// Streamlines are parameterized by arc length: with v replaced by t, the paper's dt is a length, and |v| may be anything but 0.
/// World units. Any thread; no allocation, lock or throw.
#pragma once
#include "engine/base/vec.h"

namespace catena::haptics::equation {

/// Eq. 1: p_k = p_(k-1) + v(p_(k-1)) dt, here along t: the linear constraint, one Euler step.
inline Vec3 linear_step(const Vec3& p, const Vec3& t, double dt) noexcept { return p + dt * t; }

/// Eq. 2: dt = v.(x - p) / |v|^2, here t.(x - p): distance along the line to the foot of the perpendicular from the probe. `e` is x - p.
/// Zero at a local extremum of the distance between the probe and the streamline.
inline double distance_to_foot(const Vec3& e, const Vec3& t) noexcept { return dot(e, t); }

/// Eq. 5: p_(j+1) = p_j - grad s (s - s_0) / |grad s|^2, one Newton-Raphson step along the gradient to the level. `distance` is
/// (s - s_0) / |grad s|.
inline Vec3 newton_step_to_level(const Vec3& p, const Vec3& n, double distance) noexcept { return p - n * distance; }

/// Eq. 6: p_0 = x - grad s (grad s.(x - p)) / |grad s|^2, the projection of the probe onto the tangent plane at the proxy, here as the step
/// p_0 - p. `e` is x - p.
inline Vec3 tangential_component(const Vec3& e, const Vec3& n) noexcept { return e - n * dot(n, e); }

/// Eq. 7: tau_f = u tau_min + (1 - u) tau_max. `hard` is the weight of tau_max: 1 - u as printed; |u| in the safe law, by which dragging is
/// the harder the closer the field is to the surface's normal, as the paper's text says.
inline double drag_threshold(double hard, double tau_min, double tau_max) noexcept { return (1 - hard) * tau_min + hard * tau_max; }

/// Eqs. 8-9: u = cos(theta) = [grad s . v] sigma(|grad s| |v|). Both vectors come safely normalized (friction/friction_contact.h); sigma is
/// the product of their factors, which goes to 0 where one of them is ill-defined.
inline double cosine(const Vec3& field, double field_factor, const Vec3& surface, double surface_factor) noexcept {
  return field_factor * surface_factor * dot(field, surface);
}

}  // namespace catena::haptics::equation
