// SPDX-License-Identifier: MIT
/// One explicit Runge-Kutta step of q' = rate(q), for any space (world or index coordinates, or a state with further components, such as
/// the time) and any tableau.
/// Bitwise reversible: only products (h a) k are formed, so that h -> -h and k -> -k give the same sums.
/// Any thread; no allocation, lock or throw.
#pragma once
#include "engine/geometry/flow/flow.h"

namespace catena::flow {

/// Butcher tableau of an explicit Runge-Kutta method. Stages 0..stages-1 advance (weights b); one more evaluation at the end of the
/// step gives the first stage of the next step, and completes the error estimate of the embedded pairs (weights e = b - b^).
///   euler; rk2 midpoint; rk3 Kutta; rk4 classical; rkf34 Fehlberg 3(4); dp54 Dormand-Prince 5(4).
struct Tableau {
  int order = 1;
  int stages = 1;         ///< Number of stages, without the one at the end of the step.
  bool embedded = false;  ///< e and e_last are meaningful.
  double a[6][5] = {};
  double b[6] = {};
  double e[6] = {};
  double e_last = 0;
  /// dp54: weights of the stages, the last one that of the end, in the term by which the continuous extension of order 4 (Hairer, Norsett
  /// and Wanner 1993) differs from the cubic Hermite: theta^2 (1 - theta)^2 h sum of d_i k_i.
  double d[7] = {};
};

namespace tableaus {

inline constexpr Tableau euler{1, 1, false, {}, {1}, {}, 0};
inline constexpr Tableau rk2{2, 2, false, {{}, {1.0 / 2}}, {0, 1}, {}, 0};
inline constexpr Tableau rk3{3, 3, false, {{}, {1.0 / 2}, {-1, 2}}, {1.0 / 6, 4.0 / 6, 1.0 / 6}, {}, 0};
inline constexpr Tableau rk4{4, 4, false, {{}, {1.0 / 2}, {0, 1.0 / 2}, {0, 0, 1}}, {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6}, {}, 0};
inline constexpr Tableau rkf34{3,
                               4,
                               true,
                               {{}, {1.0 / 4}, {4.0 / 81, 32.0 / 81}, {57.0 / 98, -432.0 / 343, 1053.0 / 686}},
                               {1.0 / 6, 0, 27.0 / 52, 49.0 / 156},
                               {1.0 / 6 - 43.0 / 288, 0, 27.0 / 52 - 243.0 / 416, 49.0 / 156 - 343.0 / 1872},
                               -1.0 / 12};
inline constexpr Tableau dp54{5,
                              6,
                              true,
                              {{},
                               {1.0 / 5},
                               {3.0 / 40, 9.0 / 40},
                               {44.0 / 45, -56.0 / 15, 32.0 / 9},
                               {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
                               {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656}},
                              {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84},
                              {71.0 / 57600, 0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525},
                              -1.0 / 40,
                              {-12715105075.0 / 11282082432, 0, 87487479700.0 / 32700410799, -10690763975.0 / 1880347072,
                               701980252875.0 / 199316789632, -1453857185.0 / 822651844, 69997945.0 / 29380423}};

}  // namespace tableaus

/// Returns the tableau of a method; `linear` (Eqs. 1-2) advects like Euler.
inline const Tableau& tableau_of(Method method) {
  switch (method) {
    case Method::linear:
    case Method::euler:
      return tableaus::euler;
    case Method::rk2:
      return tableaus::rk2;
    case Method::rk3:
      return tableaus::rk3;
    case Method::rk4:
      return tableaus::rk4;
    case Method::rkf34:
      return tableaus::rkf34;
    case Method::dp54:
      return tableaus::dp54;
  }
  return tableaus::rkf34;
}

/// Result of runge_kutta_step(). `State` is a vector space with +, += and multiplication by a number.
template <class State>
struct StepOf {
  State displacement{};
  State end_rate{};  ///< Rate at the end of the step, if requested.
  State error{};     ///< Error estimate of the embedded pair.
  State bend{};      ///< h sum of d_i k_i (Tableau), if requested.
  StopReason stop = StopReason::none;
  int evaluations = 0;
};
using Step = StepOf<Vec3>;  ///< Step of a position.

/// Takes one step of size h from q. `rate(q, out)` returns a StopReason; `first` is the rate at q; `want_last` requests the rate at the end
/// and, for embedded pairs, the error; `kBend` requests the term of the continuous extension. If a stage stops, `stop` is set and the
/// displacement is meaningless.
template <bool kBend = false, class State, class Rate>
StepOf<State> runge_kutta_step(const Tableau& tableau, const State& q, const State& first, double h, bool want_last, Rate&& rate) noexcept {
  StepOf<State> step;
  State k[6];
  k[0] = first;
  for (int i = 1; i < tableau.stages; ++i) {
    State d = (h * tableau.a[i][0]) * k[0];
    for (int j = 1; j < i; ++j) d += (h * tableau.a[i][j]) * k[j];
    ++step.evaluations;
    step.stop = rate(q + d, k[i]);
    if (step.stop != StopReason::none) return step;
  }
  step.displacement = (h * tableau.b[0]) * k[0];
  for (int i = 1; i < tableau.stages; ++i) step.displacement += (h * tableau.b[i]) * k[i];
  if (!want_last) return step;
  ++step.evaluations;
  step.stop = rate(q + step.displacement, step.end_rate);
  if (step.stop != StopReason::none || !tableau.embedded) return step;
  step.error = (h * tableau.e[0]) * k[0];
  for (int i = 1; i < tableau.stages; ++i) step.error += (h * tableau.e[i]) * k[i];
  step.error += (h * tableau.e_last) * step.end_rate;
  if constexpr (kBend) {
    step.bend = (h * tableau.d[6]) * step.end_rate;
    for (int i = 0; i < tableau.stages; ++i) step.bend += (h * tableau.d[i]) * k[i];
  }
  return step;
}

/// Factor by which the step size changes after an error: 0.9 (tolerance/error)^(1/4), clamped to `min_factor`..`max_factor`. Uses square
/// roots only, so that results are bitwise repeatable.
inline double step_factor(double error, double tolerance, double min_factor, double max_factor) {
  if (!(error > 0)) return max_factor;
  const double factor = 0.9 * std::sqrt(std::sqrt(tolerance / error));
  return factor > min_factor ? std::min(factor, max_factor) : min_factor;
}

}  // namespace catena::flow
