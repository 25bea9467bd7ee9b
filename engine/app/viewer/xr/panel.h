/// A panel that stands in the room, a flat picture of so many pixels, and a controller that points at it.
///   the panel  middle c, orientation q: its right is q x, its up q y, and it is read from the side that q z points to
///   the ray    from the controller's aim pose along its -z; it meets the panel where (o + s d - c) . n = 0, s > 0, from the readable side
///   the pixel  x from the left edge, y from the top, the centre of pixel (i, j) at (i + 0.5, j + 0.5)
/// PanelPointer makes a mouse of it: the panel that was pressed keeps the pointer until the press ends, also beside its edges, as a window
/// keeps a mouse. Metres, pixels. The frame thread.
#pragma once
#include <optional>

#include "engine/base/vec.h"

namespace catena::xr_interaction {

struct Panel {
  Vec3 center_m{0.0};
  Quat orientation{kIdentityRotation};
  double width_m = 1, height_m = 0.75;
  double width_px = 800, height_px = 600;
};

struct AimRay {
  Vec3 origin_m{0.0}, direction{0.0, 0.0, -1.0};  ///< unit
};
AimRay aim_ray(const Vec3& position_m, const Quat& aim);

struct PanelHit {
  double x_px = 0, y_px = 0;
  double distance_m = 0;
  bool is_inside = true;  ///< of the panel's edges
};

/// Where the ray meets the panel's plane; nothing from behind, along it, or away from it.
std::optional<PanelHit> intersect(const Panel& panel, const AimRay& ray);

/// How far a head is turned about the vertical: it looks along -z of that. Looking straight up or down: not at all.
Quat heading_rotation(const Quat& head);
/// Before a head: `distance_m` along where it looks, level, turned to it, `drop_m` lower than the eyes.
Panel place_in_front(const Vec3& head_m, const Quat& head, double distance_m, double drop_m, Panel panel);

class PanelPointer {
 public:
  struct Mouse {
    bool has_pointer = false;  ///< the panel has the pointer: the controller's select means it, and not the data behind it
    double x_px = 0, y_px = 0;
    bool pressed = false;
  };
  /// Each picture. `selects`: the controller's button.
  Mouse step(const Panel& panel, const AimRay& ray, bool selects);

 private:
  bool captured_ = false, was_selecting_ = false;
  double x_px_ = 0, y_px_ = 0;
};

}  // namespace catena::xr_interaction
