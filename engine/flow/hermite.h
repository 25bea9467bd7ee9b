/// The cubic between two knots, and the root finder that its feet are found with. Any thread; no allocation, lock or throw.
#pragma once
#include <cmath>

#include "engine/base/vec.h"

namespace catena::flow {

/// A bracketed root by the Illinois rule, bounded and bit for bit repeatable: f(a) and f(b) have opposite signs (or one is 0).
template <class F>
double illinois_root(double a, double fa, double b, double fb, F&& f) noexcept {
  if (fa == 0) return a;
  if (fb == 0) return b;
  double best = std::fabs(fa) < std::fabs(fb) ? a : b, last = best;
  for (int i = 0; i < 64; ++i) {
    double m = a + (b - a) * (fa / (fa - fb));
    if (i > 32 || !(m > std::fmin(a, b) && m < std::fmax(a, b))) m = 0.5 * (a + b);
    const double fm = f(m);
    best = m;
    if (fm == 0 || std::fabs(m - last) <= 1e-16 * std::fabs(m) || m == a || m == b) break;
    last = m;
    if ((fm > 0) == (fb > 0)) {
      b = m;
      fb = fm;
      fa *= 0.5;
    } else {
      a = b;
      fa = fb;
      b = m;
      fb = fm;
    }
  }
  return best;
}

/// The cubic Hermite of one step: place and rate at both ends. c(theta), theta in [0, 1]; exact at theta = 0.
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
