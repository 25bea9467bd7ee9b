// SPDX-License-Identifier: MIT
/// Views of a headset user's eyes, and the initial placement of the world in the local space. Pure functions, any thread.
#pragma once
#include "engine/base/placement.h"
#include "render/frame/frame_packet.h"
#include "render/stereo/stereo_views.h"

namespace catena::render {

inline constexpr double kArmLengthM = 0.7;                             ///< arm's length
inline constexpr double kMaxDownPitch_deg = 40, kMaxUpPitch_deg = 15;  ///< limits of the initial elevation angle
/// Returns the initial placement of the world for a user whose eyes are at the origin of the local space: level (the view's up is the
/// vertical), with the view's target at distance_m, seen at the same elevation as in the view: straight ahead and down, as on a desk. The
/// elevation of a view from steeply above or below is limited to kMaxDownPitch_deg or kMaxUpPitch_deg, which is comfortable to look at.
Placement make_initial_placement(const View& view, double distance_m = kArmLengthM);

/// Eye of the headset in the local space: position in meters, orthonormal axes (columns: right, up, back), field of view.
struct XrEye {
  Vec3 position{0.0};
  Mat3 local_from_eye{1.0};
  FovTangents tangents;
};
/// Returns the view of an eye in the world. Errors as make_headset_view().
Result<View> make_xr_eye_view(const Placement& placement, const XrEye& eye);

}  // namespace catena::render
