/// What is followed, by which method, and which way it leads: the unit direction u = v/|v| of a Flow at a place, along which arc-length
/// integration goes. Correct for |v| from 1e-323 to 1e308.
/// Line fields (v ~ -v) follow the axis of the interpolated dyads (engine/field/line_field.h), turned to the side of a reference
/// direction; where the coherence of the dyads is below kMinCoherence there is none. Trace, both kinds of streamline links and friction
/// all go by these functions. One call is one evaluation. Any thread; no allocation, lock or throw.
#pragma once
#include <optional>
#include <string_view>

#include "engine/field/field.h"

namespace catena::flow {

/// How a step along the field is integrated.
///   linear  the paper's Eqs. 1-2 as printed: in each tick one step p + v dt, dt = v . (x - p) / |v|^2, with x the probe, p the proxy and v
///           the field at p. It is never corrected, so that p drifts off curved lines
///   euler   order 1, Eq. 1;  rk2  order 2, midpoint;  rk3  order 3, Kutta;  rk4  order 4
///   rkf34   order 3, Fehlberg 3(4), the paper's own;  dp54  order 5, Dormand and Prince. Coefficients: engine/geometry/flow/runge_kutta.h
enum class Method { linear, euler, rk2, rk3, rk4, rkf34, dp54 };
/// The method of that name, "rkf34" for instance; none for any other word.
std::optional<Method> parse_method(std::string_view word);
/// The name of a method, as scenes have it.
const char* to_string(Method method);

/// A direction field to follow: V itself, or a line field (v ~ -v), with speeds at or below min_speed counted as zero.
struct Flow {
  const field::VectorField* field = nullptr;  ///< the field; outlives this
  bool is_line_field = false;                 ///< read as a line field
  double min_speed = 0;                       ///< speeds up to this count as zero, the field's unit
};

/// Why a rate could not be given: outside the domain (or not finite), too slow, no single axis, or turned too far from the step's start.
enum class StopReason { none, outside, still, incoherent, turned };

/// The least coherence (line_axis.h) at which a line field has a direction. TrialResult on a synthetic heart with noise of 10 degrees and
/// seams of 90: noise alone leaves 0.8 to 1. At 0.2 to 0.3 the axis is off the fibre by 11 degrees in the median and by 29 at the 90th
/// percentile, below that by 16 to 22 and by 40, so that it says nothing.
inline constexpr double kMinCoherence = 0.2;

/// The unit direction of a velocity, or why there is none: not finite counts as outside, zero or <= min_speed as still.
inline StopReason unit_direction(const Vec3& v, double min_speed, Vec3& u) noexcept {
  if (!is_finite(v)) return StopReason::outside;
  u = direction(v);
  if (!(max_abs(v) > 0) || norm(v) <= min_speed) return StopReason::still;
  return StopReason::none;
}

/// The same of an axis, turned to the side of `reference`; a reference of zero leaves its own side.
inline StopReason axis_direction(const field::LineAxis& line, double min_speed, const Vec3& reference, Vec3& u) noexcept {
  u = dot(line.axis, reference) < 0 ? -line.axis : line.axis;
  if (!std::isfinite(line.speed)) return StopReason::outside;
  if (!(line.speed > min_speed)) return StopReason::still;
  return line.coherence < kMinCoherence ? StopReason::incoherent : StopReason::none;
}

/// `reference` is used by line fields only.
StopReason direction_at(const Flow& flow, const Vec3& p, const Vec3& reference, field::Cursor& cursor, Vec3& u) noexcept;

/// The direction at a seed, where no previous tangent is known; of a line field the side of the nearest voxel.
inline StopReason seed_direction(const Flow& flow, const Vec3& seed, field::Cursor& cursor, Vec3& u) noexcept {
  return direction_at(flow, seed, Vec3(0.0), cursor, u);
}

}  // namespace catena::flow
