/// Where the world stands in the room of a headset: a similarity, so that right angles stay right.
///   world = world_origin + world_from_room * room / metres_per_unit
/// Room: metres, x right, y up, z towards the person, as OpenXR has it. Pure functions, any thread.
#pragma once
#include "render/frame/frame_packet.h"
#include "render/stereo/eyes.h"

namespace catena::render {

struct Placement {
  Vec3 world_origin{0.0};      ///< of the room, in the world
  Mat3 world_from_room{1.0};   ///< a rotation
  double metres_per_unit = 1;  ///< > 0

  Vec3 to_world(const Vec3& room) const { return world_origin + world_from_room * room / metres_per_unit; }
  Vec3 to_room(const Vec3& world) const { return metres_per_unit * (transpose(world_from_room) * (world - world_origin)); }
  bool operator==(const Placement&) const = default;
};

/// How a person finds the world at first: level (the view's up is the room's), what the view looks at straight ahead and so far away.
inline constexpr double kReachM = 0.7;  ///< an arm's length
Placement first_placement(const View& view, double distance_m = kReachM);

/// An eye of the headset: in the room, orthonormal axes (columns: right, up, back), tangents of its edges.
struct RoomEye {
  Vec3 position{0.0};
  Mat3 room_from_eye{1.0};
  Tangents tangents;
};
Result<View> eye_view(const Placement& placement, const RoomEye& eye);

}  // namespace catena::render
