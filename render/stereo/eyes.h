/// Eyes beside a view: parallel axes and windows off the axis, so that all eyes see one frame at the zero-parallax distance F.
///   eye k of n stands at offset e_k = (k - (n - 1) / 2) separation along the view's right: left eye first, n is not limited
///   perspective:  window' = window - e_k / (F half_width)     (l, r = -+ a tan(fovy / 2) - e_k / F at distance 1)
///   orthographic: an oblique projection, x' = x + (depth - F) e_k / F, as a turn about the up axis by atan(e_k / F) and a frustum
///                 narrower by the cosine: no keystone, since nothing shrinks with the depth
/// Either way there is no vertical parallax, and a point at depth z lies at x_right - x_left = s (z - F) / F, over z when perspective: 0 at
/// F, uncrossed (positive) beyond, crossed nearer. Lengths in world units along the view's axis. Pure functions, any thread.
#pragma once
#include <optional>
#include <vector>

#include "render/frame/frame_packet.h"

namespace catena::render {

/// Of an eye's window, in its own widths: farther apart no picture has both.
inline constexpr double kMaxShift = 1e6;

struct EyeSettings {
  std::size_t views = 2;
  std::optional<double> separation;     ///< of neighbours, >= 0; none: a 30th of the zero-parallax distance
  std::optional<double> zero_parallax;  ///< > 0; none: the distance from the eye to its target
};

inline constexpr double kSeparationShare = 1.0 / 30;

/// `aspect`: width by height of the view's symmetric frustum. From left to right.
std::vector<View> eyes(const View& centre, double aspect, const EyeSettings& settings = {});

/// The distance that `settings` mean for this view.
double zero_parallax_distance(const View& centre, const EyeSettings& settings);

}  // namespace catena::render
