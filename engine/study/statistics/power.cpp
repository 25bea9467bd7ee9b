// SPDX-License-Identifier: MIT
#include "engine/study/statistics/power.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/study/statistics/distributions.h"

namespace catena::statistics {

double paired_power(double effect, int n, double alpha) {
  const double df = n - 1, delta = std::fabs(effect) * std::sqrt(static_cast<double>(n));
  const double critical = t_quantile(1 - 0.5 * alpha, df);
  // the two tails add up to exactly 1
  if (delta > 100 && delta > 3 * critical) return 1;
  return std::min(1.0, noncentral_t_survival(critical, df, delta) + noncentral_t_cdf(-critical, df, delta));
}

Result<int> required_subjects(double effect, double power, double alpha) {
  if (!(paired_power(effect, kMaxSubjects, alpha) >= power))
    return Error{fmt::format("{} subjects are not enough for a power of {:g} at an effect of {:g}", kMaxSubjects, power, effect)};
  int too_few = 1, enough = kMaxSubjects;  // the power with one subject is 0
  while (enough - too_few > 1) {
    const int middle = too_few + (enough - too_few) / 2;
    (paired_power(effect, middle, alpha) >= power ? enough : too_few) = middle;
  }
  return enough;
}

}  // namespace catena::statistics
