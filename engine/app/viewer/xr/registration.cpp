// SPDX-License-Identifier: MIT
#include "engine/app/viewer/xr/registration.h"

#include <fmt/format.h>

namespace catena::xr_interaction {
namespace {

constexpr double kMinEdge_m = 0.02, kMinHeight_m = 0.01;

/// Three points as a plane through their centroid.
struct Triangle {
  Vec3 centre{0.0}, normal{0.0};
  std::array<Vec3, 3> from_centre{};
  std::array<double, 3> edges{};
};

Result<Triangle> triangle_of(const std::array<Vec3, 3>& places, const char* whose) {
  Triangle out;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!is_finite(places[i])) return Error{fmt::format("point {} of {} is not finite; finite numbers were expected", i + 1, whose)};
    out.centre += places[i] / 3.0;
    out.edges[i] = norm(places[(i + 1) % 3] - places[i]);
    if (out.edges[i] < kMinEdge_m)
      return Error{fmt::format("points {} and {} of {} are {:.1f} mm apart; at least {:.0f} mm were expected", i + 1, (i + 1) % 3 + 1,
                               whose, 1e3 * out.edges[i], 1e3 * kMinEdge_m)};
  }
  for (std::size_t i = 0; i < 3; ++i) out.from_centre[i] = places[i] - out.centre;
  const Vec3 twice_area = cross(places[1] - places[0], places[2] - places[0]);
  const double height = norm(twice_area) / *std::max_element(out.edges.begin(), out.edges.end());
  if (height < kMinHeight_m)
    return Error{fmt::format("the three points of {} are nearly on one line, {:.1f} mm from it; at least {:.0f} mm were expected", whose,
                             1e3 * height, 1e3 * kMinHeight_m)};
  out.normal = direction(twice_area);
  return out;
}

}  // namespace

Result<Registration> compute_registration(const std::array<Vec3, 3>& device_m, const std::array<Vec3, 3>& room_m) {
  CATENA_TRY(const Triangle device, triangle_of(device_m, "the device"));
  CATENA_TRY(const Triangle room, triangle_of(room_m, "the room"));
  const Quat swing = shortest_arc(device.normal, room.normal);
  double sine = 0, cosine = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 turned = rotate(swing, device.from_centre[i]);
    sine += dot(room.normal, cross(turned, room.from_centre[i]));
    cosine += dot(turned, room.from_centre[i]);
  }
  Registration out;
  out.room_from_device = normalized(rotation_from_vector(std::atan2(sine, cosine) * room.normal) * swing);
  out.origin_m = room.centre - rotate(out.room_from_device, device.centre);
  double squares = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 left = out.to_room(device_m[i]) - room_m[i];
    squares += dot(left, left) / 3;
    out.edge_error_m = std::max(out.edge_error_m, std::fabs(device.edges[i] - room.edges[i]));
  }
  out.residual_m = std::sqrt(squares);
  return out;
}

}  // namespace catena::xr_interaction
