/// An axis-aligned box in the world, grown point by point. Any thread.
#pragma once
#include <limits>

#include "engine/base/vec.h"

namespace catena {

/// Empty at first: lo = infinity, hi = -infinity.
struct Bounds {
  Vec3 lo{std::numeric_limits<double>::infinity()}, hi{-std::numeric_limits<double>::infinity()};  ///< corners, world units

  /// Whether it holds no point.
  bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
  /// The middle; not a number of an empty one.
  Vec3 center() const { return 0.5 * lo + 0.5 * hi; }
  /// Length of the space diagonal; 0 of an empty one.
  double diagonal() const { return empty() ? 0 : norm(hi - lo); }
  /// Length of the longest edge; 0 of an empty one.
  double longest_edge() const { return empty() ? 0 : max_abs(hi - lo); }
  /// Corner i + 2 j + 4 k.
  Vec3 corner(int i) const { return {(i & 1) ? hi.x : lo.x, (i & 2) ? hi.y : lo.y, (i & 4) ? hi.z : lo.z}; }
  /// Whether p lies within it, faces included.
  bool contains(const Vec3& p) const { return p.x >= lo.x && p.y >= lo.y && p.z >= lo.z && p.x <= hi.x && p.y <= hi.y && p.z <= hi.z; }
  void extend(const Vec3& p, double radius = 0);  ///< what is not finite is left out
  /// Grows to hold `other`; an empty one adds nothing.
  void extend(const Bounds& other);
};

}  // namespace catena
