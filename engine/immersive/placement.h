/// Where the world of a scene stands in the room of a person: a similarity, and the hands that move it.
///   room = S R world + t       S metres of room per world unit, R a rotation, t metres
/// A haptic program has the same the other way round (haptics/servo/step.h): its metres_per_unit is S, its workspace's rotation R^-1, its
/// workspace's origin the world place of the room's origin. Room axes as a tracker has them: y up. Pure functions, any thread.
#pragma once
#include <array>
#include <optional>
#include <string>

#include "engine/base/vec.h"
#include "engine/geometry/bounds.h"

namespace catena::immersive {

struct Placement {
  double metres_per_unit = 1;         ///< S, > 0
  Quat room_from_world{kNoRotation};  ///< R
  Vec3 origin_m{0.0};                 ///< t: the room place of the world's origin
};

Vec3 room_of(const Placement& placement, const Vec3& world);
Vec3 world_of(const Placement& placement, const Vec3& room_m);

/// The box upright (its z up, its -y towards the person) with its longest edge so many metres long and its middle at `middle_m`.
Placement placed(const Bounds& box, double longest_m, const Vec3& middle_m);

/// Turned about the vertical line through `pivot_m`, counter-clockwise seen from above.
Placement turned_about(const Placement& placement, const Vec3& pivot_m, double angle_rad);

/// "1 unit = 5 cm": what a person reads while the world is scaled.
std::string scale_words(double metres_per_unit);

/// A hand in the room. Not holding: its pose does not count.
struct Hand {
  Vec3 position_m{0.0};
  Quat orientation{kNoRotation};
  bool holds = false;
};

/// The world in one hand or two. What the hands hold stays where they hold it:
///   one hand   room' = p + q q0^-1 (room - p0): carried and turned
///   two hands  the same about their middle, with S' / S = |b - a| / |b0 - a0| and the rotation that turns b0 - a0 onto b - a by the
///              shortest way, then about that axis by the mean of both hands' own twist
/// p0, q0 are where the hands were when their number last changed: taking hold with the second hand or letting go of one never makes the
/// world jump. Hands closer than 2 cm do not scale, S stays within `least` to `most`. A pose that is not finite counts as not held.
class WorldGrab {
 public:
  struct Options {
    double least_metres_per_unit = 1e-9, most_metres_per_unit = 1e9;
    bool upright = false;  ///< turns about the vertical alone
  };
  WorldGrab() = default;
  explicit WorldGrab(const Options& options) : options_(options) {}

  /// Each picture: the placement now.
  Placement move(const Placement& now, const std::array<Hand, 2>& hands);
  bool holds() const { return held_[0] || held_[1]; }

 private:
  Options options_;
  std::array<bool, 2> held_{};
  std::array<Hand, 2> start_{};
  Placement begun_;
};

}  // namespace catena::immersive
