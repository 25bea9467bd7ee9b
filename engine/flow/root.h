/// A bracketed root by the Illinois rule, bounded and bit for bit repeatable: f(a) and f(b) have opposite signs (or one is 0).
#pragma once
#include <cmath>

namespace catena::flow {

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

}  // namespace catena::flow
