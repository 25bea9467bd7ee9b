/// The hands that move the world: carried, turned and scaled, in steps turned about the person. Metres of room, y up. Pure functions and a
/// little state of the frame thread.
#pragma once
#include <array>
#include <string>

#include "engine/base/placement.h"

namespace catena::xr_interaction {

/// The world moved in the room, so that what was at `from_m` is at `to_m`:   room' = to + factor turn (room - from)
Placement move_world(const Placement& placement, const Vec3& from_m, const Quat& turn, double factor, const Vec3& to_m);

/// Turned about the vertical line through `pivot_m`, counter-clockwise seen from above.
Placement rotate_about(const Placement& placement, const Vec3& pivot_m, double angle_rad);

/// "1 unit = 5 cm": what a person reads while the world is scaled.
std::string format_scale(double metres_per_unit);

/// A hand in the room. Not holding: its pose does not count.
struct GrabController {
  Vec3 position_m{0.0};
  Quat orientation{kIdentityRotation};
  bool is_grabbing = false;
};

/// The world in one hand or two. What the hands hold stays where they hold it:
///   one hand   room' = p + q q0^-1 (room - p0): carried and turned
///   two hands  the same about their middle, times |b - a| / |b0 - a0| in scale S (meters_per_unit), and the rotation that turns b0 - a0
///   onto b - a by the
///              shortest way, then about that axis by the mean of both hands' own twist
/// p0, q0 are where the hands were when their number last changed: taking hold with the second hand or letting go of one never makes the
/// world jump. Hands closer than 2 cm do not scale, S stays within `least` to `most`. A pose that is not finite counts as not held.
class WorldGrab {
 public:
  struct Options {
    double min_meters_per_unit = 1e-9, max_meters_per_unit = 1e9;
    bool yaw_only = false;  ///< turns about the vertical alone
  };
  WorldGrab() = default;
  explicit WorldGrab(const Options& options) : options_(options) {}

  /// Each picture: the placement now.
  Placement move(const Placement& now, const std::array<GrabController, 2>& hands);
  bool is_grabbing() const { return was_grabbing_[0] || was_grabbing_[1]; }

 private:
  Options options_;
  std::array<bool, 2> was_grabbing_{};
  std::array<GrabController, 2> start_{};
  Placement start_placement_;
};

}  // namespace catena::xr_interaction
