// SPDX-License-Identifier: MIT
#include "engine/app/viewer/xr/world_grab.h"

#include <fmt/format.h>

namespace catena::xr_interaction {
namespace {

constexpr double kMinSpan_m = 0.02;
const Vec3 kUp{0.0, 1.0, 0.0};

/// Angle of the component of q that turns about the unit axis, radians.
double twist_about(const Vec3& axis, const Quat& q) { return 2 * std::atan2(dot(Vec3(q.x, q.y, q.z), axis), q.w); }

double wrapped(double angle) { return angle - 2 * M_PI * std::round(angle / (2 * M_PI)); }

/// Relative motion of both controllers since the grab began: the rotation, and the scale factor.
struct Pull {
  Quat turn{kIdentityRotation};
  double factor = 1;
};

Pull pull_of(const std::array<GrabController, 2>& from, const std::array<GrabController, 2>& to) {
  const Vec3 before = from[1].position_m - from[0].position_m, after = to[1].position_m - to[0].position_m;
  if (norm(before) < kMinSpan_m || norm(after) < kMinSpan_m) return {};
  const Vec3 axis = direction(after);
  const Quat swing = shortest_arc(direction(before), axis);
  double twist = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const Quat turned = to[i].orientation * glm::conjugate(swing * from[i].orientation);
    twist += 0.5 * wrapped(twist_about(axis, normalized(turned)));
  }
  return {normalized(rotation_from_vector(twist * axis) * swing), norm(after) / norm(before)};
}

}  // namespace

Placement move_world(const Placement& placement, const Vec3& from_m, const Quat& turn, double factor, const Vec3& to_m) {
  const Quat back = glm::conjugate(turn);
  Placement out;
  out.meters_per_unit = factor * placement.meters_per_unit;
  // through a unit quaternion, so that the matrix stays a rotation after many turns
  out.world_from_room = glm::mat3_cast(normalized(glm::quat_cast(placement.world_from_room) * back));
  out.world_origin = placement.to_world(from_m - rotate(back, to_m) / factor);
  return out;
}

Placement rotate_about(const Placement& placement, const Vec3& pivot_m, double angle_rad) {
  return move_world(placement, pivot_m, rotation_from_vector(angle_rad * kUp), 1, pivot_m);
}

std::string format_scale(double metres_per_unit) {
  struct Unit {
    double metres;
    const char* word;
  };
  constexpr Unit units[] = {{1e3, "km"}, {1, "m"}, {1e-2, "cm"}, {1e-3, "mm"}, {1e-6, "um"}};
  for (const Unit& unit : units)
    if (metres_per_unit >= unit.metres * (1 - 1e-9) || &unit == std::end(units) - 1)
      return fmt::format("1 unit = {:.3g} {}", metres_per_unit / unit.metres, unit.word);
  return {};
}

Placement WorldGrab::move(const Placement& now, const std::array<GrabController, 2>& hands) {
  std::array<bool, 2> held{};
  for (std::size_t i = 0; i < 2; ++i) held[i] = hands[i].is_grabbing && is_finite(hands[i].position_m) && is_finite(hands[i].orientation);
  if (held != was_grabbing_) {
    was_grabbing_ = held;
    start_ = hands;
    start_placement_ = now;
    return now;
  }
  if (!is_grabbing()) return now;

  Pull pull;
  Vec3 from, to;
  if (held[0] && held[1]) {
    pull = pull_of(start_, hands);
    from = 0.5 * (start_[0].position_m + start_[1].position_m);
    to = 0.5 * (hands[0].position_m + hands[1].position_m);
  } else {
    const std::size_t i = held[0] ? 0 : 1;
    pull.turn = normalized(hands[i].orientation * glm::conjugate(start_[i].orientation));
    from = start_[i].position_m;
    to = hands[i].position_m;
  }
  if (options_.yaw_only) pull.turn = rotation_from_vector(wrapped(twist_about(kUp, pull.turn)) * kUp);

  const double scale =
      std::clamp(start_placement_.meters_per_unit * pull.factor, options_.min_meters_per_unit, options_.max_meters_per_unit);
  return move_world(start_placement_, from, pull.turn, scale / start_placement_.meters_per_unit, to);
}

}  // namespace catena::xr_interaction
