// SPDX-License-Identifier: MIT
#include "render/stereo/xr_views.h"

#include <algorithm>
#include <cmath>

#include "render/frame/camera.h"

namespace catena::render {

namespace {
constexpr double kRadian = M_PI / 180;
}

Placement make_initial_placement(const View& view, double distance_m) {
  // an up direction along the axis is replaced as in make_camera()
  const Camera axes = make_camera(view, 1, 1, {});
  const bool level = std::fabs(dot(direction(view.up), axes.back)) < 0.999;
  const Vec3 up = level ? direction(view.up) : axes.up;
  const Vec3 back = direction(axes.back - dot(axes.back, up) * up), right = cross(up, back);
  const double distance = norm(view.position - view.target);
  Placement placement;
  placement.world_from_room = Mat3(right, up, back);
  placement.meters_per_unit = distance_m / (distance > 0 ? distance : 1);
  const double above = std::asin(std::clamp(dot(axes.back, up), -1.0, 1.0));
  const double angle = std::clamp(above, -kMaxUpPitch_deg * kRadian, kMaxDownPitch_deg * kRadian);
  placement.world_origin = view.target + (std::cos(angle) * back + std::sin(angle) * up) * (distance_m / placement.meters_per_unit);
  return placement;
}

Result<View> make_xr_eye_view(const Placement& placement, const XrEye& eye) {
  return make_headset_view(placement.to_world(eye.position), placement.world_from_room * eye.local_from_eye, eye.tangents);
}

}  // namespace catena::render
