/// Velocity and velocity gradient of a vector field at a place, without trouble at either end of the double range.
///   grids: both of the trilinear or cubic cell, exactly, one fetch;  formulas: central differences over 2e-6 L, seven fetches
/// And Newton's search for a zero of the field near a place: nodes, saddles, centres. Central differences over 2e-6 L; minimum-norm
/// steps, so that planar fields and lines of zeros work. Scale of the field is irrelevant. Any thread; no allocation.
#pragma once
#include <optional>

#include "engine/field/field.h"
#include "engine/geometry/flow/flow.h"

namespace catena::flow {

struct VelocityGradient {
  Vec3 v{0.0};            ///< divided by `scale`
  Mat3 gradient{0.0};     ///< column j is dv/dx_j, divided by `scale`; 1 / world unit
  double scale = 0;       ///< the largest |v_i| met; 0: no motion here
  bool is_valid = false;  ///< inside the domain and mask, and finite
};

/// Fetches that one call makes.
int velocity_gradient_fetches(const field::VectorField& field) noexcept;
VelocityGradient compute_velocity_gradient(const field::VectorField& field, const Vec3& world, field::Cursor& cursor,
                                           int& evaluations) noexcept;

inline Vec3 curl(const Mat3& gradient) {
  return {gradient[1][2] - gradient[2][1], gradient[2][0] - gradient[0][2], gradient[0][1] - gradient[1][0]};
}

/// A zero within `radius` of p, or nothing. `evaluations` is added to; at most `budget` are spent.
std::optional<Vec3> find_zero(const Flow& flow, const Vec3& p, const Vec3& reference, double radius, field::Cursor& cursor, int budget,
                              int& evaluations) noexcept;

}  // namespace catena::flow
