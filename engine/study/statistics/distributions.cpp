// SPDX-License-Identifier: MIT
#include "engine/study/statistics/distributions.h"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace catena::statistics {
namespace {

namespace bm = boost::math;
/// Policy without exceptions: the callers validate their arguments. Calculations use double, so that results do not depend on the width of
/// long double.
using Quiet =
    bm::policies::policy<bm::policies::domain_error<bm::policies::ignore_error>, bm::policies::pole_error<bm::policies::ignore_error>,
                         bm::policies::overflow_error<bm::policies::ignore_error>,
                         bm::policies::underflow_error<bm::policies::ignore_error>,
                         bm::policies::evaluation_error<bm::policies::ignore_error>, bm::policies::promote_double<false>>;
using Student = bm::students_t_distribution<double, Quiet>;
using Noncentral = bm::non_central_t_distribution<double, Quiet>;
using Normal = bm::normal_distribution<double, Quiet>;
using ChiSquared = bm::chi_squared_distribution<double, Quiet>;
using Beta = bm::beta_distribution<double, Quiet>;

}  // namespace

double two_sided_p(double t, double df) {
  if (std::isinf(t)) return 0;
  return std::min(1.0, 2 * bm::cdf(bm::complement(Student(df), std::fabs(t))));
}

double t_quantile(double probability, double df) { return bm::quantile(Student(df), probability); }

double normal_quantile(double probability) { return bm::quantile(Normal(), probability); }

double two_sided_normal_p(double z) { return std::erfc(std::fabs(z) / std::sqrt(2.0)); }

double noncentral_t_cdf(double t, double df, double delta) { return std::clamp(bm::cdf(Noncentral(df, delta), t), 0.0, 1.0); }

double noncentral_t_survival(double t, double df, double delta) {
  return std::clamp(bm::cdf(bm::complement(Noncentral(df, delta), t)), 0.0, 1.0);
}

double solve_noncentrality(double t, double df, double probability) {
  if (t < 0) return -solve_noncentrality(-t, df, 1 - probability);
  if (t > 200) return t * std::sqrt(bm::quantile(bm::complement(ChiSquared(df), probability)) / df);
  // P(T <= t) decreases with delta: bisection
  double low = -10 - t, high = 10 + 4 * t;
  for (int i = 0; i < 100 && high - low > 1e-10 * (1 + t); ++i) {
    const double middle = 0.5 * (low + high);
    (noncentral_t_cdf(t, df, middle) > probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Interval proportion_interval(double hits, double n, double confidence) {
  const double tail_probability = 0.5 * (1 - confidence);
  return {hits > 0 ? bm::quantile(Beta(hits, n - hits + 1), tail_probability) : 0.0,
          hits < n ? bm::quantile(bm::complement(Beta(hits + 1, n - hits), tail_probability)) : 1.0};
}

}  // namespace catena::statistics
