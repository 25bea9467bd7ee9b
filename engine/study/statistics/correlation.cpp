// SPDX-License-Identifier: MIT
#include "engine/study/statistics/correlation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/study/statistics/distributions.h"
#include "engine/study/statistics/summary.h"

namespace catena::statistics {
namespace {

/// Means, and sums of squares and products of the deviations from them.
struct Moments {
  double mean_x = 0, mean_y = 0, xx = 0, yy = 0, xy = 0;
};

bool has_spread(double squares, std::span<const double> values) {
  double largest = 0;
  for (const double v : values) largest = std::max(largest, std::fabs(v));
  return std::sqrt(squares / static_cast<double>(values.size())) > 16 * std::numeric_limits<double>::epsilon() * largest;
}

Result<Moments> compute_moments(std::span<const double> x, std::span<const double> y, int min_count) {
  CATENA_ASSERT(x.size() == y.size());
  CATENA_CHECK(check_values(x, min_count));
  CATENA_CHECK(check_values(y, min_count));
  CATENA_TRY(const Summary of_x, summarize(x));
  CATENA_TRY(const Summary of_y, summarize(y));
  Moments m{of_x.mean, of_y.mean};
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = x[i] - m.mean_x, dy = y[i] - m.mean_y;
    m.xx += dx * dx;
    m.yy += dy * dy;
    m.xy += dx * dy;
  }
  if (!std::isfinite(m.xx) || !std::isfinite(m.yy)) return Error{"the values are too large to sum"};
  return m;
}

Result<double> r_of(std::span<const double> x, std::span<const double> y, int min_count) {
  CATENA_TRY(const Moments m, compute_moments(x, y, min_count));
  if (!has_spread(m.xx, x) || !has_spread(m.yy, y))
    return Error{fmt::format("all {} values of one measure are equal, so that there is no correlation", x.size())};
  const double r = m.xy / (std::sqrt(m.xx) * std::sqrt(m.yy));
  // collinear points give exactly 1 or -1 in spite of rounding
  return std::fabs(r) > 1 - 8 * std::numeric_limits<double>::epsilon() ? std::copysign(1.0, r) : r;
}

}  // namespace

Result<Correlation> pearson(std::span<const double> x, std::span<const double> y, double confidence) {
  CATENA_TRY(const double r, r_of(x, y, 3));
  Correlation c;
  c.n = static_cast<int>(x.size());
  c.r = r;
  c.df = c.n - 2;
  const double unexplained = (1 - r) * (1 + r);
  c.t = unexplained > 0 ? r * std::sqrt(c.df / unexplained) : std::copysign(std::numeric_limits<double>::infinity(), r);
  c.p = two_sided_p(c.t, c.df);
  if (c.n < 4) return c;
  const double half_width = normal_quantile(0.5 + 0.5 * confidence) / std::sqrt(c.n - 3.0);
  c.low = unexplained > 0 ? std::tanh(std::atanh(r) - half_width) : r;
  c.high = unexplained > 0 ? std::tanh(std::atanh(r) + half_width) : r;
  return c;
}

Result<CorrelationDifference> compare_correlations(std::span<const double> a, std::span<const double> b, std::span<const double> c,
                                                   std::span<const double> d) {
  constexpr int kMinSubjects = 10;
  CATENA_TRY(const double ab, r_of(a, b, kMinSubjects));
  CATENA_TRY(const double cd, r_of(c, d, kMinSubjects));
  CATENA_TRY(const double ac, r_of(a, c, kMinSubjects));
  CATENA_TRY(const double ad, r_of(a, d, kMinSubjects));
  CATENA_TRY(const double bc, r_of(b, c, kMinSubjects));
  CATENA_TRY(const double bd, r_of(b, d, kMinSubjects));
  const double k =
      (ac - bc * ab) * (bd - bc * cd) + (ad - ac * cd) * (bc - ac * ab) + (ac - ad * cd) * (bd - ad * ab) + (ad - ab * bd) * (bc - bd * cd);
  const double scale = 2 * (1 - ab * ab) * (1 - cd * cd);
  const double independent_part = scale > 0 ? 1 - k / scale : 0;
  if (!(independent_part > 1e-12)) return Error{"the two correlations cannot be compared: the measures are linearly dependent"};
  CorrelationDifference difference{static_cast<int>(a.size()), ab, cd};
  difference.z = std::sqrt((difference.n - 3) / 2.0) * (std::atanh(ab) - std::atanh(cd)) / std::sqrt(independent_part);
  difference.p = two_sided_normal_p(difference.z);
  return difference;
}

Result<RegressionLine> regression(std::span<const double> x, std::span<const double> y) {
  CATENA_TRY(const Moments m, compute_moments(x, y, 2));
  if (!has_spread(m.xx, x)) return Error{"all values of x are equal, so that there is no regression line"};
  const double slope = m.xy / m.xx;
  return RegressionLine{slope, m.mean_y - slope * m.mean_x};
}

}  // namespace catena::statistics
