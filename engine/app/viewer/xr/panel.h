// SPDX-License-Identifier: MIT
/// A panel in the tracking space, a rectangle showing an image of given pixel size, and a controller pointing at it.
///   panel   center c, orientation q: right is q x, up is q y, the readable side faces q z
///   ray     from the controller's aim pose along its -z; it hits the panel where (o + s d - c) . n = 0, s > 0, from the readable side
///   pixel   x from the left edge, y from the top; the center of pixel (i, j) is at (i + 0.5, j + 0.5)
/// PanelPointer turns the ray into a mouse: a press that starts on the panel captures the pointer until it ends, also outside the edges, as
/// for a window. Meters, pixels. Frame thread.
#pragma once
#include <optional>

#include "engine/base/vec.h"

namespace catena::xr_interaction {

/// A rectangle in the tracking space and the size of its image.
struct Panel {
  Vec3 center_m{0.0};
  Quat orientation{kIdentityRotation};
  double width_m = 1, height_m = 0.75;
  double width_px = 800, height_px = 600;
};

/// Ray from a controller.
struct AimRay {
  Vec3 origin_m{0.0}, direction{0.0, 0.0, -1.0};  ///< Direction of unit length.
};
/// Returns the ray along -z of an aim pose.
AimRay aim_ray(const Vec3& position_m, const Quat& aim);

/// Intersection of a ray with the plane of a panel.
struct PanelHit {
  double x_px = 0, y_px = 0;
  double distance_m = 0;
  bool is_inside = true;  ///< Whether the hit lies within the panel's edges.
};

/// Returns the intersection of the ray with the panel's plane; nothing for a ray from behind, parallel to it, or pointing away from it.
std::optional<PanelHit> intersect(const Panel& panel, const AimRay& ray);

/// Returns the rotation of a head about the vertical; the head looks along -z of it. Identity if it looks straight up or down.
Quat heading_rotation(const Quat& head);
/// Returns the panel placed in front of a head: `distance_m` along its horizontal viewing direction, facing it, `drop_m` below the eyes.
Panel place_in_front(const Vec3& head_m, const Quat& head, double distance_m, double drop_m, Panel panel);

/// Mouse on a panel, driven by the ray of a controller.
class PanelPointer {
 public:
  struct Mouse {
    bool has_pointer = false;  ///< True: the controller's select button acts on the panel and not on the data behind it.
    double x_px = 0, y_px = 0;
    bool pressed = false;
  };
  /// Call once per frame. `selects`: whether the controller's select button is down.
  Mouse step(const Panel& panel, const AimRay& ray, bool selects);

 private:
  bool captured_ = false, was_selecting_ = false;
  double x_px_ = 0, y_px_ = 0;
};

}  // namespace catena::xr_interaction
