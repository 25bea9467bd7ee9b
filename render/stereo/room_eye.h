/// The eyes of a person in the room of a headset, and where the world stands in it at first. Pure functions, any thread.
#pragma once
#include "engine/geometry/placement.h"
#include "render/frame/frame_packet.h"
#include "render/stereo/eyes.h"

namespace catena::render {

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
