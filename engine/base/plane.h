// SPDX-License-Identifier: MIT
/// A plane, and the half space on the side to which its normal points.
#pragma once
#include <cstddef>

#include "engine/base/vec.h"

namespace catena {

/// Plane in world space. `normal` need not have unit length.
struct Plane {
  Vec3 point{0.0};             ///< point on the plane, world units
  Vec3 normal{0.0, 0.0, 1.0};  ///< vector normal to the plane
  bool operator==(const Plane&) const = default;
};

/// Maximum number of clip planes of one image.
inline constexpr std::size_t kMaxClipPlanes = 8;

}  // namespace catena
