#include "engine/immersive/placement.h"

#include <fmt/format.h>

#include "engine/base/result.h"

namespace catena::immersive {
namespace {

constexpr double kLeastSpan_m = 0.02;
const Vec3 kUp{0.0, 1.0, 0.0};

/// The part of q that turns about the unit axis, radians.
double twist_about(const Vec3& axis, const Quat& q) { return 2 * std::atan2(dot(Vec3(q.x, q.y, q.z), axis), q.w); }

double wrapped(double angle) { return angle - 2 * M_PI * std::round(angle / (2 * M_PI)); }

/// What two hands do together since they took hold: the rotation, and the factor.
struct Pull {
  Quat turn{kNoRotation};
  double factor = 1;
};

Pull pull_of(const std::array<Hand, 2>& from, const std::array<Hand, 2>& to) {
  const Vec3 before = from[1].position_m - from[0].position_m, after = to[1].position_m - to[0].position_m;
  if (norm(before) < kLeastSpan_m || norm(after) < kLeastSpan_m) return {};
  const Vec3 axis = direction(after);
  const Quat swing = shortest_arc(direction(before), axis);
  double twist = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const Quat turned = to[i].orientation * glm::conjugate(swing * from[i].orientation);
    twist += 0.5 * wrapped(twist_about(axis, normalised(turned)));
  }
  return {normalised(rotation_of(twist * axis) * swing), norm(after) / norm(before)};
}

}  // namespace

Vec3 room_of(const Placement& p, const Vec3& world) { return p.origin_m + rotate(p.room_from_world, world) * p.metres_per_unit; }

Vec3 world_of(const Placement& p, const Vec3& room_m) {
  return rotate(glm::conjugate(p.room_from_world), room_m - p.origin_m) / p.metres_per_unit;
}

Placement placed(const Bounds& box, double longest_m, const Vec3& middle_m) {
  CATENA_ASSERT(longest_m > 0);
  Placement out;
  out.room_from_world = rotation_of(Vec3(-0.5 * M_PI, 0, 0));  // z up becomes y up
  const double longest = box.empty() ? 2 : box.longest_edge();
  out.metres_per_unit = longest > 0 ? longest_m / longest : 1;
  const Vec3 middle = box.empty() ? Vec3(0.0) : box.centre();
  out.origin_m = middle_m - rotate(out.room_from_world, middle) * out.metres_per_unit;
  return out;
}

Placement turned_about(const Placement& placement, const Vec3& pivot_m, double angle_rad) {
  Placement out = placement;
  const Quat turn = rotation_of(angle_rad * kUp);
  out.room_from_world = normalised(turn * placement.room_from_world);
  out.origin_m = pivot_m + rotate(turn, placement.origin_m - pivot_m);
  return out;
}

std::string scale_words(double metres_per_unit) {
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

Placement WorldGrab::move(const Placement& now, const std::array<Hand, 2>& hands) {
  std::array<bool, 2> held{};
  for (std::size_t i = 0; i < 2; ++i) held[i] = hands[i].holds && is_finite(hands[i].position_m) && is_finite(hands[i].orientation);
  if (held != held_) {
    held_ = held;
    start_ = hands;
    begun_ = now;
    return now;
  }
  if (!holds()) return now;

  Pull pull;
  Vec3 from, to;
  if (held[0] && held[1]) {
    pull = pull_of(start_, hands);
    from = 0.5 * (start_[0].position_m + start_[1].position_m);
    to = 0.5 * (hands[0].position_m + hands[1].position_m);
  } else {
    const std::size_t i = held[0] ? 0 : 1;
    pull.turn = normalised(hands[i].orientation * glm::conjugate(start_[i].orientation));
    from = start_[i].position_m;
    to = hands[i].position_m;
  }
  if (options_.upright) pull.turn = rotation_of(wrapped(twist_about(kUp, pull.turn)) * kUp);

  Placement out;
  out.metres_per_unit = std::clamp(begun_.metres_per_unit * pull.factor, options_.least_metres_per_unit, options_.most_metres_per_unit);
  out.room_from_world = normalised(pull.turn * begun_.room_from_world);
  out.origin_m = to + rotate(pull.turn, begun_.origin_m - from) * (out.metres_per_unit / begun_.metres_per_unit);
  return out;
}

}  // namespace catena::immersive
