// SPDX-License-Identifier: MIT
/// Views defined by a display: a flat screen in physical space, or the field of view of a headset. Each eye is a View with its own axes,
/// window and aspect (pixels need not be square). World units, any one unit. Pure functions, any thread.
#pragma once
#include <optional>
#include <vector>

#include "engine/base/result.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// Rectangular display screen seen from `eye`, for CAVE, fish tank and desktop (R. Kooima, Generalized perspective projection, 2009).
///   vr, vu, vn: unit right, up and normal towards the eye; d = -vn.(pa - pe); at distance 1: l = vr.(pa - pe) / d, r = vr.(pb - pe) / d,
///   b = vu.(pa - pe) / d, t = vu.(pc - pe) / d
/// make_screen_view() returns an Error for corners that do not form a rectangle and for an eye on or behind the screen.
struct Screen {
  Vec3 lower_left{0.0}, lower_right{0.0}, upper_left{0.0};  ///< pa, pb, pc
};
/// Returns the off-axis view of the screen from an eye position.
Result<View> make_screen_view(const Screen& screen, const Vec3& eye);

/// Field of view of an eye: tangents of the angles from the axis to the edges; left and down are negative if the axis is inside the image.
///   P00 = 2 / (r - l), P02 = (r + l) / (r - l), P11 = 2 / (d - u), P12 = (u + d) / (d - u)     (Vulkan's clip axes)
struct FovTangents {
  double left = -1, right = 1, up = 1, down = -1;
};
/// Returns the view of an eye that looks along the -z of its axes (columns of `world_from_eye`: right, up, back; orthonormal); eyes may be
/// canted. An Error for edges out of order or numbers that are not finite.
Result<View> make_headset_view(const Vec3& position, const Mat3& world_from_eye, const FovTangents& tangents);

/// Stereo views around a center view: parallel axes and off-axis windows, so that all eyes share one frame at the zero-parallax distance F.
///   eye k of n is at offset e_k = (k - (n - 1) / 2) separation along the view's right: left eye first, n is not limited
///   perspective:  window' = window - e_k / (F half_width)     (l, r = -+ a tan(fovy / 2) - e_k / F at distance 1)
///   orthographic: an oblique projection, x' = x + (depth - F) e_k / F, as a turn about the up axis by atan(e_k / F) and a frustum narrower
///                 by the cosine: no keystone, since nothing shrinks with the depth
/// In both cases there is no vertical parallax, and a point at depth z has the parallax x_right - x_left = s (z - F) / F, divided by z for
/// perspective: 0 at F, uncrossed (positive) beyond, crossed nearer. Lengths in world units along the view's axis. Pure functions, any
/// thread.

/// Maximum offset of an eye's window, in its own widths: beyond it, no scene is visible to both eyes.
inline constexpr double kMaxWindowShift = 1e6;

/// Number and distances of the stereo views.
struct StereoSettings {
  std::size_t views = 2;
  std::optional<double> separation;     ///< distance of neighboring eyes, >= 0; nullopt: a 30th of the zero-parallax distance
  std::optional<double> zero_parallax;  ///< > 0; nullopt: the distance from the camera to its target
};

inline constexpr double kDefaultSeparationRatio = 1.0 / 30;

/// Returns the views from left to right. `aspect`: width / height of the view's symmetric frustum.
std::vector<View> make_stereo_views(const View& centre, double aspect, const StereoSettings& settings = {});

/// Returns the zero-parallax distance that `settings` imply for this view.
double zero_parallax_distance(const View& centre, const StereoSettings& settings);

}  // namespace catena::render
