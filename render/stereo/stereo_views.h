/// Views that are given by a display: a flat screen in the room, or the tangents of a headset. Each eye is a View of its own, with its own
/// axes, its own window and its own aspect (pixels need not be square). World units, any one unit. Pure functions, any thread.
#pragma once
#include <optional>
#include <vector>

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
Result<View> make_screen_view(const Screen& screen, const Vec3& eye);

/// FovTangents of the angles from the axis to the edges: left and down are negative where the axis is inside the picture.
///   P00 = 2 / (r - l), P02 = (r + l) / (r - l), P11 = 2 / (d - u), P12 = (u + d) / (d - u)     (Vulkan's clip axes)
struct FovTangents {
  double left = -1, right = 1, up = 1, down = -1;
};
/// The eye looks along the -z of its axes (columns of `world_from_eye`: right, up, back; orthonormal); eyes may be canted.
/// Errors: edges out of order, numbers that are not finite.
Result<View> make_headset_view(const Vec3& position, const Mat3& world_from_eye, const FovTangents& tangents);

/// Eyes beside a view: parallel axes and windows off the axis, so that all eyes see one frame at the zero-parallax distance F.
///   eye k of n stands at offset e_k = (k - (n - 1) / 2) separation along the view's right: left eye first, n is not limited
///   perspective:  window' = window - e_k / (F half_width)     (l, r = -+ a tan(fovy / 2) - e_k / F at distance 1)
///   orthographic: an oblique projection, x' = x + (depth - F) e_k / F, as a turn about the up axis by atan(e_k / F) and a frustum
///                 narrower by the cosine: no keystone, since nothing shrinks with the depth
/// Either way there is no vertical parallax, and a point at depth z lies at x_right - x_left = s (z - F) / F, over z when perspective: 0 at
/// F, uncrossed (positive) beyond, crossed nearer. Lengths in world units along the view's axis. Pure functions, any thread.

/// Of an eye's window, in its own widths: farther apart no picture has both.
inline constexpr double kMaxWindowShift = 1e6;

struct StereoSettings {
  std::size_t views = 2;
  std::optional<double> separation;     ///< of neighbours, >= 0; none: a 30th of the zero-parallax distance
  std::optional<double> zero_parallax;  ///< > 0; none: the distance from the eye to its target
};

inline constexpr double kDefaultSeparationRatio = 1.0 / 30;

/// `aspect`: width by height of the view's symmetric frustum. From left to right.
std::vector<View> make_stereo_views(const View& centre, double aspect, const StereoSettings& settings = {});

/// The distance that `settings` mean for this view.
double zero_parallax_distance(const View& centre, const StereoSettings& settings);

}  // namespace catena::render
