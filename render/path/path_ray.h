// SPDX-License-Identifier: MIT
/// Rays of the path tracer, in display units, and what they meet.
#pragma once
#include <limits>

#include "engine/base/color.h"
#include "engine/base/vec.h"

namespace catena::render {

/// Half line.
struct PathRay {
  Vec3 origin{0.0}, direction{0.0};  ///< unit direction
  /// Returns the position at a distance.
  Vec3 at(double t) const { return origin + t * direction; }
};

/// Interval of distances along a ray; empty if from >= to.
struct PathInterval {
  double from = 0, to = std::numeric_limits<double>::infinity();
};

/// Surface that a ray meets.
struct SurfaceHit {
  double t = std::numeric_limits<double>::infinity();  ///< distance; infinite: none
  Vec3 normal{0.0}, shading_normal{0.0};               ///< of the geometry, and of the shading; not turned, not of unit length
  Color color{};                                       ///< linear
  float opacity = 1;
  double epsilon = 0;     ///< distance from the surface at which a new ray starts, display units
  bool is_unlit = false;  ///< the color is what is seen: slices
  explicit operator bool() const { return t < std::numeric_limits<double>::infinity(); }
};

}  // namespace catena::render
