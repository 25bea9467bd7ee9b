/// The eyes of a person in the room of a headset, and where the world stands in it at first. Pure functions, any thread.
#pragma once
#include "engine/base/placement.h"
#include "render/frame/frame_packet.h"
#include "render/stereo/stereo_views.h"

namespace catena::render {

/// How a person whose eyes are at the room's origin finds the world at first: level (the view's up is the room's), what the view looks at
/// so far away, and seen from as high above as the view sees it: straight ahead and down, as on a desk. A view from steeply above or below
/// is taken from kMostDown or kMostUp, where looking does not tire.
inline constexpr double kArmLengthM = 0.7;  ///< an arm's length
inline constexpr double kMaxDown_deg = 40, kMaxUp_deg = 15;
Placement make_initial_placement(const View& view, double distance_m = kArmLengthM);

/// An eye of the headset: in the room, orthonormal axes (columns: right, up, back), tangents of its edges.
struct XrEye {
  Vec3 position{0.0};
  Mat3 local_from_eye{1.0};
  FovTangents tangents;
};
Result<View> make_xr_eye_view(const Placement& placement, const XrEye& eye);

}  // namespace catena::render
