/// The unit direction u = v/|v| of a Flow at a place: what arc-length integration follows. Correct for |v| from 1e-323 to 1e308.
/// Line fields (v ~ -v) are turned to the side of a reference direction. One call is one evaluation.
/// Any thread; no allocation, lock or throw.
#pragma once
#include "engine/flow/runge_kutta.h"

namespace catena::flow {

/// The unit direction of a velocity, or why there is none: not finite counts as outside, zero or <= min_speed as still.
inline Stop unit_direction(const Vec3& v, double min_speed, Vec3& u) noexcept {
  if (!is_finite(v)) return Stop::outside;
  u = direction(v);
  if (!(max_abs(v) > 0) || norm(v) <= min_speed) return Stop::still;
  return Stop::none;
}

/// `reference` is used by line fields only.
Stop direction_at(const Flow& flow, const Vec3& p, const Vec3& reference, field::Cursor& cursor, Vec3& u) noexcept;

/// The direction at a seed, where no previous tangent is known: on the grid of a line field the corner nearest to the seed
/// is the reference, so that opposite signs within the cell do not cancel.
Stop seed_direction(const Flow& flow, const Vec3& seed, field::Cursor& cursor, Vec3& u) noexcept;

/// A line field's side at the place `f` of a cell, without a tangent to align with: the direction of the corner nearest to it
/// that moves at all, so that opposite signs do not cancel. Zero where no corner moves.
Vec3 nearest_side(const field::VectorCell& cell, const Vec3& f) noexcept;

}  // namespace catena::flow
