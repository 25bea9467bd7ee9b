/// Where the world stands in the room of a person: a similarity, so that right angles stay right.
///   world = world_origin + world_from_room * room / meters_per_unit
/// Room: metres, x right, y up, z towards the person, as a headset's tracker has it. A haptic program has the same three as its workspace
/// (haptics/servo/servo_tick.h). Any thread.
#pragma once
#include "engine/base/vec.h"

namespace catena {

struct Placement {
  Vec3 world_origin{0.0};      ///< of the room, in the world
  Mat3 world_from_room{1.0};   ///< a rotation
  double meters_per_unit = 1;  ///< > 0

  Vec3 to_world(const Vec3& room) const { return world_origin + world_from_room * room / meters_per_unit; }
  Vec3 to_room(const Vec3& world) const { return meters_per_unit * ((world - world_origin) * world_from_room); }  // v * R = R^T v
  bool operator==(const Placement&) const = default;
};

}  // namespace catena
