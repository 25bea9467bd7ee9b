/// One explicit Runge-Kutta step of q' = rate(q), for any space (world or index) and any tableau.
/// Reversible bit for bit: only products (h a) k are formed, so that h -> -h and k -> -k give the same sums.
/// Any thread; no allocation, lock or throw.
#pragma once
#include "engine/flow/tableau.h"

namespace catena::flow {

/// Why a rate could not be given: outside the domain (or not finite), too slow, no single axis, or turned too far from the step's start.
enum class Stop { none, outside, still, incoherent, turned };

struct Step {
  Vec3 displacement{0.0};
  Vec3 last{0.0};   ///< rate at the end of the step, if asked for
  Vec3 error{0.0};  ///< of the embedded pair
  Stop stop = Stop::none;
  int evaluations = 0;
};

/// `rate(q, out)` returns a Stop; `first` is the rate at q. On a stop the displacement is meaningless.
template <class Rate>
Step runge_kutta_step(const Tableau& tableau, const Vec3& q, const Vec3& first, double h, bool want_last, Rate&& rate) noexcept {
  Step step;
  Vec3 k[6];
  k[0] = first;
  for (int i = 1; i < tableau.stages; ++i) {
    Vec3 d = (h * tableau.a[i][0]) * k[0];
    for (int j = 1; j < i; ++j) d += (h * tableau.a[i][j]) * k[j];
    ++step.evaluations;
    step.stop = rate(q + d, k[i]);
    if (step.stop != Stop::none) return step;
  }
  step.displacement = (h * tableau.b[0]) * k[0];
  for (int i = 1; i < tableau.stages; ++i) step.displacement += (h * tableau.b[i]) * k[i];
  if (!want_last) return step;
  ++step.evaluations;
  step.stop = rate(q + step.displacement, step.last);
  if (step.stop != Stop::none || !tableau.embedded) return step;
  step.error = (h * tableau.e[0]) * k[0];
  for (int i = 1; i < tableau.stages; ++i) step.error += (h * tableau.e[i]) * k[i];
  step.error += (h * tableau.e_last) * step.last;
  return step;
}

/// The factor by which a step changes after an error: (tolerance/error)^(1/4), safety 0.9, between `least` and `most`.
/// Square roots only, so that bits repeat.
inline double step_factor(double error, double tolerance, double least, double most) {
  if (!(error > 0)) return most;
  const double factor = 0.9 * std::sqrt(std::sqrt(tolerance / error));
  return factor > least ? std::min(factor, most) : least;
}

}  // namespace catena::flow
