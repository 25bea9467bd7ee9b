// SPDX-License-Identifier: MIT
#include "engine/study/statistics/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/study/statistics/distributions.h"

namespace catena::statistics {

Outcome check_values(std::span<const double> values, int min_count) {
  for (const double x : values)
    if (!std::isfinite(x)) return Error{"a value is not a finite number"};
  if (values.size() < static_cast<std::size_t>(min_count))
    return Error{
        fmt::format("at least {} values are required, but there {} {}", min_count, values.size() == 1 ? "is" : "are", values.size())};
  return Done{};
}

Result<Summary> summarize(std::span<const double> values, double confidence) {
  CATENA_CHECK(check_values(values, 2));
  const double n = static_cast<double>(values.size());
  Summary s;
  s.n = static_cast<int>(values.size());
  s.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0;
  for (const double x : values) squares += (x - s.mean) * (x - s.mean);
  s.sd = std::sqrt(squares / (n - 1));
  s.half_width = t_quantile(0.5 + 0.5 * confidence, n - 1) * s.sd / std::sqrt(n);
  if (!std::isfinite(s.mean) || !std::isfinite(s.half_width)) return Error{"the values are too large to sum"};
  return s;
}

Result<PairedTest> paired_test(std::span<const double> a, std::span<const double> b, double confidence) {
  CATENA_ASSERT(a.size() == b.size());
  CATENA_CHECK(check_values(a, 2));
  CATENA_CHECK(check_values(b, 2));
  std::vector<double> differences(a.size());
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    differences[i] = a[i] - b[i];
    largest = std::max({largest, std::fabs(a[i]), std::fabs(b[i])});
  }
  CATENA_TRY(const Summary s, summarize(differences, confidence));
  if (s.sd <= 16 * std::numeric_limits<double>::epsilon() * largest)
    return Error{fmt::format("all {} differences are equal, so that the spread is 0", s.n)};
  PairedTest test;
  test.n = s.n;
  test.difference = s.mean;
  test.low = s.low();
  test.high = s.high();
  test.sd = s.sd;
  test.df = s.n - 1;
  const double root = std::sqrt(static_cast<double>(s.n));
  test.effect = s.mean / s.sd;
  test.t = test.effect * root;
  test.p = two_sided_p(test.t, test.df);
  const double tail_probability = 0.5 * (1 - confidence);
  test.effect_low = solve_noncentrality(test.t, test.df, 1 - tail_probability) / root;
  test.effect_high = solve_noncentrality(test.t, test.df, tail_probability) / root;
  return test;
}

std::vector<double> holm_correction(std::span<const double> p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return p[i] < p[j]; });
  std::vector<double> corrected(p.size());
  double last = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    last = std::clamp(static_cast<double>(p.size() - k) * p[order[k]], last, 1.0);
    corrected[order[k]] = last;
  }
  return corrected;
}

}  // namespace catena::statistics
