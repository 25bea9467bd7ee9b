// SPDX-License-Identifier: MIT
/// Registration of a haptic device in tracking space ("room") from three points touched with its grip, each known in device meters and in
/// tracking space (for example with the controller's tip held to the grip).
///   room = R device + t, the rigid motion with the least sum of squared distances over the three points. Both triangles are planar: R
///   turns one plane's normal onto the other's, then within the plane by  angle = atan2(sum n . (d_i x r_i), sum d_i . r_i),  with d, r
///   relative to the triangle centers
/// The residual measures how accurately the user touched: the root mean square distance left at the three points, and the largest
/// difference between two edges that should have equal lengths. Meters. An Error if points are not finite, closer than 2 cm, or nearly
/// collinear (triangle height over its longest edge below 1 cm), since the rotation about that line would be undetermined. Pure function,
/// any thread.
#pragma once
#include <array>

#include "engine/base/result.h"
#include "engine/base/vec.h"

namespace catena::xr_interaction {

/// Rigid motion from device meters to tracking space, and its residual.
struct Registration {
  Quat room_from_device{kIdentityRotation};
  Vec3 origin_m{0.0};       ///< Origin of the device in tracking space.
  double residual_m = 0;    ///< Root mean square distance at the points.
  double edge_error_m = 0;  ///< Largest difference between the two lengths of an edge.
  /// Maps a point from device meters to tracking space.
  Vec3 to_room(const Vec3& device_m) const { return origin_m + rotate(room_from_device, device_m); }
};

/// Computes the registration; the points of both arrays correspond by index.
Result<Registration> compute_registration(const std::array<Vec3, 3>& device_m, const std::array<Vec3, 3>& room_m);

}  // namespace catena::xr_interaction
