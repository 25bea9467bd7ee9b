// SPDX-License-Identifier: MIT
/// Position, orientation and scale of the physical space of the user in the world: a similarity transform, so right angles are preserved.
///   world = world_origin + world_from_room * room_point_m / meters_per_unit
/// Room coordinates: meters, x right, y up, z towards the user, as a headset's tracker reports them. A haptic program has the same three
/// members as its workspace (haptics/servo/servo_tick.h). Any thread.
#pragma once
#include "engine/base/vec.h"

namespace catena {

/// Similarity transform between room coordinates (meters) and world coordinates.
struct Placement {
  Vec3 world_origin{0.0};      ///< world position of the room's origin
  Mat3 world_from_room{1.0};   ///< rotation from room axes to world axes
  double meters_per_unit = 1;  ///< meters per world unit, > 0

  /// Converts a point from room to world coordinates, and back.
  Vec3 to_world(const Vec3& room_point_m) const { return world_origin + world_from_room * room_point_m / meters_per_unit; }
  Vec3 to_room(const Vec3& world) const { return meters_per_unit * ((world - world_origin) * world_from_room); }  // v * R = R^T v
  bool operator==(const Placement&) const = default;
};

}  // namespace catena
