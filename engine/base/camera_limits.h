/// Where an eye may be: what the picture's numbers (doubles on the way to floats, whose squares are taken) still resolve; and how many
/// lights it may have. Any thread.
#pragma once
#include <cstddef>
#include <string>

#include "engine/base/vec.h"

namespace catena {

/// World units; degrees; the height of an orthographic picture in world units.
inline constexpr double kMaxCameraCoordinate = 1e15, kMinFovyDeg = 1e-3, kMaxFovyDeg = 179.9, kMaxOrthoHeight = 1e15,
                        kMinOrthoHeight = 1e-15;

/// Lights of one picture.
inline constexpr std::size_t kMaxLights = 4;

/// What is wrong with an eye's place, and what was expected, as a sentence; empty: nothing. A target counts as the eye's own place
/// where the difference of the two is rounding.
std::string validate_view(const Vec3& position, const Vec3& target);

/// The same of an angle of view, without its subject: "is 0; degrees ... were expected".
std::string validate_fovy(double fovy_deg);

}  // namespace catena
