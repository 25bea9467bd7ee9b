// SPDX-License-Identifier: MIT
/// Limits of camera parameters that rendering can still resolve (doubles are converted to floats and squared on the way), and the limits on
/// the number of lights. Any thread.
#pragma once
#include <cstddef>
#include <string>

#include "engine/base/vec.h"

namespace catena {

/// Largest absolute coordinate of a camera position or target (world units), range of the vertical field of view (degrees), and range of
/// the height of an orthographic view (world units).
inline constexpr double kMaxCameraCoordinate = 1e15, kMinFovyDeg = 1e-3, kMaxFovyDeg = 179.9, kMaxOrthoHeight = 1e15,
                        kMinOrthoHeight = 1e-15;

/// Maximum number of lights of one image.
inline constexpr std::size_t kMaxLights = 4;

/// Checks a camera position and target, world units. Returns an empty string when they are usable, else one sentence that states the
/// problem and what was expected. A target that differs from the position only by rounding counts as equal to it.
std::string validate_view(const Vec3& position, const Vec3& target);

/// Checks a vertical field of view in degrees. Returns an empty string when it is usable, else a sentence without its subject: "is 0;
/// degrees ... were expected".
std::string validate_fovy(double fovy_deg);

}  // namespace catena
