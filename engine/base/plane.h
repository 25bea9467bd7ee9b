/// A plane, and the half space to which its normal points.
#pragma once
#include <cstddef>

#include "engine/base/vec.h"

namespace catena {

/// `normal` need not be unit.
struct Plane {
  Vec3 point{0.0}, normal{0.0, 0.0, 1.0};  ///< a place on the plane and an arrow across it, world units
  bool operator==(const Plane&) const = default;
};

/// Clip planes of one picture.
inline constexpr std::size_t kMaxClipPlanes = 8;

}  // namespace catena
