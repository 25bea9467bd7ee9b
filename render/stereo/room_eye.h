/// The eyes of a person in the room of a headset, and where the world stands in it at first. Pure functions, any thread.
#pragma once
#include "engine/geometry/placement.h"
#include "render/frame/frame_packet.h"
#include "render/stereo/eyes.h"

namespace catena::render {

/// How a person whose eyes are at the room's origin finds the world at first: level (the view's up is the room's), what the view looks at
/// so far away, and seen from as high above as the view sees it: straight ahead and down, as on a desk. A view from steeply above or below
/// is taken from kMostDown or kMostUp, where looking does not tire.
inline constexpr double kReachM = 0.7;  ///< an arm's length
inline constexpr double kMostDown_deg = 40, kMostUp_deg = 15;
Placement first_placement(const View& view, double distance_m = kReachM);

/// An eye of the headset: in the room, orthonormal axes (columns: right, up, back), tangents of its edges.
struct RoomEye {
  Vec3 position{0.0};
  Mat3 room_from_eye{1.0};
  Tangents tangents;
};
Result<View> eye_view(const Placement& placement, const RoomEye& eye);

}  // namespace catena::render
