// SPDX-License-Identifier: MIT
/// Moving the world with XR controllers: translation, rotation and scaling, and snap turns about the user. Meters in tracking space
/// ("room"), y up. Pure functions and a small state of the frame thread.
#pragma once
#include <array>
#include <string>

#include "engine/base/placement.h"

namespace catena::xr_interaction {

/// Returns the placement moved so that a point at `from_m` comes to `to_m`:   room' = to + factor turn (room - from)
Placement move_world(const Placement& placement, const Vec3& from_m, const Quat& turn, double factor, const Vec3& to_m);

/// Returns the placement rotated about the vertical line through `pivot_m`, counter-clockwise seen from above.
Placement rotate_about(const Placement& placement, const Vec3& pivot_m, double angle_rad);

/// Returns "1 unit = 5 cm", shown to the user while the world is scaled.
std::string format_scale(double metres_per_unit);

/// Pose of a controller in tracking space and whether it grabs the world; without a grab the pose is ignored.
struct GrabController {
  Vec3 position_m{0.0};
  Quat orientation{kIdentityRotation};
  bool is_grabbing = false;
};

/// Moves the world with one grabbing controller or two; the grabbed points of the world stay at the controllers:
///   one   room' = p + q q0^-1 (room - p0): translation and rotation
///   two   the same about their midpoint; the scale S (meters_per_unit) times |b - a| / |b0 - a0|; the rotation that turns b0 - a0
///         onto b - a by the shortest arc, then about that axis by the mean twist of both controllers
/// p0, q0 are the poses when the set of grabbing controllers last changed, so that grabbing with the second controller or releasing one
/// never makes the world jump. Controllers closer than 2 cm do not scale; S stays between min_meters_per_unit and max_meters_per_unit. A
/// controller whose pose is not finite does not grab.
class WorldGrab {
 public:
  struct Options {
    double min_meters_per_unit = 1e-9, max_meters_per_unit = 1e9;
    bool yaw_only = false;  ///< Rotation about the vertical only.
  };
  WorldGrab() = default;
  explicit WorldGrab(const Options& options) : options_(options) {}

  /// Call once per frame; returns the new placement.
  Placement move(const Placement& now, const std::array<GrabController, 2>& hands);
  bool is_grabbing() const { return was_grabbing_[0] || was_grabbing_[1]; }

 private:
  Options options_;
  std::array<bool, 2> was_grabbing_{};
  std::array<GrabController, 2> start_{};
  Placement start_placement_;
};

}  // namespace catena::xr_interaction
