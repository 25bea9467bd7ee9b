// SPDX-License-Identifier: MIT
/// Angle between two rulers. Pure; any thread.
#pragma once
#include <array>
#include <optional>

#include "engine/base/vec.h"

namespace catena::app {

/// Angle in degrees. With a shared end: 0 to 180, between the directions away from it; otherwise 0 to 90, between the lines.
struct RulerAngle {
  double degrees = 0;
  bool has_shared_end = false;
};

/// Returns the angle between two rulers, each given by its ends, world. An end is shared if two ends are closer together than a twentieth
/// of the shorter ruler. nullopt: a ruler has no length.
std::optional<RulerAngle> angle_between(const std::array<Vec3, 2>& a, const std::array<Vec3, 2>& b);

}  // namespace catena::app
