/// A plane, and the half space on the side to which its normal points.
#pragma once
#include <cstddef>

#include "engine/base/vec.h"

namespace catena {

/// Plane in world space. `normal` need not have unit length.
struct Plane {
  /// A point on the plane and a vector normal to it, world units.
  Vec3 point{0.0}, normal{0.0, 0.0, 1.0};
  bool operator==(const Plane&) const = default;
};

/// Maximum number of clip planes of one image.
inline constexpr std::size_t kMaxClipPlanes = 8;

}  // namespace catena
