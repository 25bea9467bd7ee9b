// SPDX-License-Identifier: MIT
/// Velocity and velocity gradient of a vector field at a position, free of overflow and underflow over the whole double range.
///   grids: exact derivatives of the trilinear or cubic cell, one fetch;  formulas: central differences over 2e-6 L, seven fetches
/// Also a Newton search for a zero of the field near a position: nodes, saddles, centers. Central differences over 2e-6 L; minimum-norm
/// steps, so that planar fields and lines of zeros work. The magnitude of the field is irrelevant. Any thread; no allocation.
#pragma once
#include <optional>

#include "engine/field/field.h"
#include "engine/geometry/flow/flow.h"

namespace catena::flow {

/// Velocity and gradient at a position, both divided by `scale`.
struct VelocityGradient {
  Vec3 v{0.0};            ///< Velocity, divided by `scale`.
  Mat3 gradient{0.0};     ///< Column j is dv/dx_j, divided by `scale`; 1 / world unit.
  double scale = 0;       ///< Largest |v_i| among the samples used; 0: zero velocity.
  bool is_valid = false;  ///< The samples lie inside the domain and mask and are finite.
};

/// Number of fetches of one compute_velocity_gradient() call.
int velocity_gradient_fetches(const field::VectorField& field) noexcept;
/// Computes velocity and gradient at a world position; `evaluations` is increased by the fetches made.
VelocityGradient compute_velocity_gradient(const field::VectorField& field, const Vec3& world, field::Cursor& cursor,
                                           int& evaluations) noexcept;

/// Curl of the velocity, from its gradient (column j is dv/dx_j).
inline Vec3 curl(const Mat3& gradient) {
  return {gradient[1][2] - gradient[2][1], gradient[2][0] - gradient[0][2], gradient[0][1] - gradient[1][0]};
}

/// Returns a zero of the field within `radius` (world units) of p, or nothing. `evaluations` is increased by the evaluations spent, about
/// `budget` at most. `reference`: the side to which the axes of a line field are turned; grids of line fields have no isolated zeros.
std::optional<Vec3> find_zero(const Flow& flow, const Vec3& p, const Vec3& reference, double radius, field::Cursor& cursor, int budget,
                              int& evaluations) noexcept;

}  // namespace catena::flow
