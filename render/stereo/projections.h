/// Views that are given by a display: a flat screen in the room, or the tangents of a headset. Each eye is a View of its own, with its own
/// axes, its own window and its own aspect (pixels need not be square). World units, any one unit. Pure functions, any thread.
#pragma once
#include "engine/base/result.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// A rectangular screen seen from `eye`: CAVE, fish tank and desktop alike (R. Kooima, Generalized perspective projection, 2009).
///   vr, vu, vn: unit right, up and normal towards the eye; d = -vn.(pa - pe); at distance 1: l = vr.(pa - pe) / d, r = vr.(pb - pe) / d,
///   b = vu.(pa - pe) / d, t = vu.(pc - pe) / d
/// Errors: corners that span no rectangle, an eye on the screen or behind it.
struct Screen {
  Vec3 lower_left{0.0}, lower_right{0.0}, upper_left{0.0};  ///< pa, pb, pc
};
Result<View> screen_view(const Screen& screen, const Vec3& eye);

/// Tangents of the angles from the axis to the edges: left and down are negative where the axis is inside the picture.
///   P00 = 2 / (r - l), P02 = (r + l) / (r - l), P11 = 2 / (d - u), P12 = (u + d) / (d - u)     (Vulkan's clip axes)
struct Tangents {
  double left = -1, right = 1, up = 1, down = -1;
};
/// The eye looks along the -z of its axes (columns of `world_from_eye`: right, up, back; orthonormal); eyes may be canted.
/// Errors: edges out of order, numbers that are not finite.
Result<View> headset_view(const Vec3& position, const Mat3& world_from_eye, const Tangents& tangents);

}  // namespace catena::render
