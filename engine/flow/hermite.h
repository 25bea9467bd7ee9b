/// The cubic Hermite of one step: place and rate at both ends. c(theta), theta in [0, 1]; exact at theta = 0.
#pragma once
#include "engine/base/vec.h"
#include "engine/flow/root.h"

namespace catena::flow {

struct Hermite {
  Vec3 c0, c1, c2, c3;

  /// From q over `displacement`, in a step of length h with rates w0 and w1 at its ends.
  Hermite(const Vec3& q, const Vec3& displacement, double h, const Vec3& w0, const Vec3& w1)
      : c0(q), c1(h * w0), c2(3.0 * displacement - 2.0 * c1 - h * w1), c3(c1 + h * w1 - 2.0 * displacement) {}

  Vec3 at(double theta) const { return c0 + theta * (c1 + theta * (c2 + theta * c3)); }
  Vec3 derivative(double theta) const { return c1 + theta * (2.0 * c2 + theta * (3.0 * c3)); }  ///< by theta

  /// theta where (x - c).c' = 0, given its signs at the ends: the foot of x on this piece.
  double foot(const Vec3& x, double g0, double g1) const {
    return illinois_root(0.0, g0, 1.0, g1, [&](double theta) { return dot(x - at(theta), derivative(theta)); });
  }
};

}  // namespace catena::flow
