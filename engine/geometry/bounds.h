/// An axis-aligned box in the world, grown point by point. Any thread.
#pragma once
#include <limits>

#include "engine/base/vec.h"

namespace catena {

/// Empty at first: lo = infinity, hi = -infinity.
struct Bounds {
  Vec3 lo{std::numeric_limits<double>::infinity()}, hi{-std::numeric_limits<double>::infinity()};

  bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
  Vec3 centre() const { return 0.5 * lo + 0.5 * hi; }
  double diagonal() const { return empty() ? 0 : norm(hi - lo); }
  double longest_edge() const { return empty() ? 0 : max_abs(hi - lo); }
  /// Corner i + 2 j + 4 k.
  Vec3 corner(int i) const { return {(i & 1) ? hi.x : lo.x, (i & 2) ? hi.y : lo.y, (i & 4) ? hi.z : lo.z}; }
  bool has(const Vec3& p) const { return p.x >= lo.x && p.y >= lo.y && p.z >= lo.z && p.x <= hi.x && p.y <= hi.y && p.z <= hi.z; }
  void add(const Vec3& p, double radius = 0);  ///< what is not finite is left out
  void add(const Bounds& other);
};

}  // namespace catena
