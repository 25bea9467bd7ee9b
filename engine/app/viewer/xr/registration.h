/// Where a haptic device on the desk stands in the room: three places that the grip touches, each known in the device's metres and in the
/// tracker's (the controller's tip held to the grip, say).
///   room = R device + t, the rigid motion of the least sum of squared distances over the three places. Both triangles lie in planes: R
///   turns one plane's normal onto the other's, then within it by  angle = atan2(sum n . (d_i x r_i), sum d_i . r_i),  d, r from the
///   centres
/// The residual tells how well the person touched: the root mean square of what is left at the three places, and the largest difference of
/// two edges that should be equally long. Metres. Errors: places that are not finite, closer than 2 cm, or nearly on one line (the triangle
/// is less than 1 cm high over its longest edge): a turn about that line would be a guess. Pure function, any thread.
#pragma once
#include <array>

#include "engine/base/result.h"
#include "engine/base/vec.h"

namespace catena::xr_interaction {

struct Registration {
  Quat room_from_device{kIdentityRotation};
  Vec3 origin_m{0.0};       ///< the room place of the device's origin
  double residual_m = 0;    ///< root mean square
  double edge_error_m = 0;  ///< the largest difference of an edge's two lengths
  Vec3 to_room(const Vec3& device_m) const { return origin_m + rotate(room_from_device, device_m); }
};

Result<Registration> compute_registration(const std::array<Vec3, 3>& device_m, const std::array<Vec3, 3>& room_m);

}  // namespace catena::xr_interaction
