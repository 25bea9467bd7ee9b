/// Moves of a camera: turned about what it looks at, closer, along an axis, fitted. Angles in degrees. Pure functions, any thread.
#pragma once
#include <optional>
#include <string_view>

#include "render/frame/camera.h"

namespace catena::render {

/// Turns the camera by `azimuth` about the axis `up` through its target (counter-clockwise seen from above), after raising it by
/// `elevation` about the picture's horizontal. It takes its own up along: the picture never flips at a pole.
View turned(const View& view, double azimuth_deg, double elevation_deg);

/// Enlarges the middle of the picture: the same eye and perspective, a smaller field of view (or height).
///   tan(fovy' / 2) = tan(fovy / 2) / factor
View zoomed(const View& view, double factor);

/// "+x", "-x", "+y", "-y", "+z", "-z": the way the camera looks (from the other side of the scene); up is +z, for +-z it is +y.
/// "iso": from +x, -y, +z at equal angles. What comes back points from the scene towards the eye.
std::optional<Vec3> axis_direction(std::string_view words);

/// fit_view() along such an axis.
std::optional<View> axis_view(const Bounds& bounds, double aspect, std::string_view words, double fovy_deg = 30);

/// The same direction, up, angle and projection, with all of the box in the picture.
View fitted(const View& view, const Bounds& bounds, double aspect);

}  // namespace catena::render
