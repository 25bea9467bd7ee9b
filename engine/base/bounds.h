// SPDX-License-Identifier: MIT
/// Axis-aligned bounding box in world space, grown point by point. A value type: any thread.
#pragma once
#include <limits>

#include "engine/base/export.h"
#include "engine/base/vec.h"

namespace catena {

/// Axis-aligned box. A default-constructed box is empty: lo = infinity, hi = -infinity.
struct CATENA_EXPORT Bounds {
  Vec3 lo{std::numeric_limits<double>::infinity()};   ///< lowest corner, world units
  Vec3 hi{-std::numeric_limits<double>::infinity()};  ///< highest corner, world units

  /// Returns true when the box contains no point.
  bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
  /// Returns the center of the box; NaN for an empty box.
  Vec3 center() const { return 0.5 * lo + 0.5 * hi; }
  /// Returns the length of the space diagonal, world units; 0 for an empty box.
  double diagonal() const { return empty() ? 0 : norm(hi - lo); }
  /// Returns the length of the longest edge, world units; 0 for an empty box.
  double longest_edge() const { return empty() ? 0 : max_abs(hi - lo); }
  /// Returns corner number i + 2 j + 4 k, where each of i, j, k is 0 for `lo` and 1 for `hi` along x, y, z.
  Vec3 corner(int i) const { return {(i & 1) ? hi.x : lo.x, (i & 2) ? hi.y : lo.y, (i & 4) ? hi.z : lo.z}; }
  /// Returns true when p lies inside the box; its faces belong to it.
  bool contains(const Vec3& p) const { return p.x >= lo.x && p.y >= lo.y && p.z >= lo.z && p.x <= hi.x && p.y <= hi.y && p.z <= hi.z; }
  /// Returns the box scaled about the origin by factors > 0, axis by axis.
  Bounds scaled(const Vec3& factors) const { return {lo * factors, hi * factors}; }
  /// Grows the box to contain the ball of `radius` world units around p. A point that is not finite is ignored.
  void extend(const Vec3& p, double radius = 0);
  /// Grows the box to contain `other`; an empty box changes nothing.
  void extend(const Bounds& other);
};

}  // namespace catena
