// SPDX-License-Identifier: MIT
#include "engine/app/viewer/xr/panel.h"

namespace catena::xr_interaction {
namespace {

constexpr double kAlong = 1e-6;  // component of the ray's direction across the panel: smaller ones count as parallel to it

}  // namespace

AimRay aim_ray(const Vec3& position_m, const Quat& aim) { return {position_m, direction(rotate(aim, Vec3(0, 0, -1)))}; }

std::optional<PanelHit> intersect(const Panel& panel, const AimRay& ray) {
  const Vec3 normal = rotate(panel.orientation, Vec3(0, 0, 1)), from_middle = ray.origin_m - panel.center_m;
  const double towards = -dot(normal, ray.direction), before = dot(normal, from_middle);
  if (!(towards > kAlong) || !(before > 0)) return std::nullopt;
  PanelHit hit;
  hit.distance_m = before / towards;
  const Vec3 at = from_middle + hit.distance_m * ray.direction;
  const double right = dot(rotate(panel.orientation, Vec3(1, 0, 0)), at), up = dot(rotate(panel.orientation, Vec3(0, 1, 0)), at);
  if (!std::isfinite(right) || !std::isfinite(up)) return std::nullopt;
  hit.x_px = (right / panel.width_m + 0.5) * panel.width_px;
  hit.y_px = (0.5 - up / panel.height_m) * panel.height_px;
  hit.is_inside = hit.x_px >= 0 && hit.x_px < panel.width_px && hit.y_px >= 0 && hit.y_px < panel.height_px;
  return hit;
}

Quat heading_rotation(const Quat& head) {
  const Vec3 back = rotate(head, Vec3(0, 0, 1));
  // straight up or down: no rotation about the vertical
  if (!(std::hypot(back.x, back.z) > kAlong)) return kIdentityRotation;
  return rotation_from_vector(std::atan2(back.x, back.z) * Vec3(0, 1, 0));
}

Panel place_in_front(const Vec3& head_m, const Quat& head, double distance_m, double drop_m, Panel panel) {
  panel.orientation = heading_rotation(head);
  panel.center_m = head_m - distance_m * rotate(panel.orientation, Vec3(0, 0, 1)) - Vec3(0, drop_m, 0);
  return panel;
}

PanelPointer::Mouse PanelPointer::step(const Panel& panel, const AimRay& ray, bool selects) {
  const std::optional<PanelHit> hit = intersect(panel, ray);
  const bool inside = hit && hit->is_inside;
  // only a press that begins on the panel is captured
  if (!selects) captured_ = false;
  if (selects && !was_selecting_ && inside) captured_ = true;
  was_selecting_ = selects;
  if (hit) {
    x_px_ = hit->x_px;
    y_px_ = hit->y_px;
  }
  return {captured_ || (inside && !selects), x_px_, y_px_, captured_};
}

}  // namespace catena::xr_interaction
