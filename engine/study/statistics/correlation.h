// SPDX-License-Identifier: MIT
/// Statistics of two measures of the same subjects: Pearson's correlation, the difference of two correlations, the regression line. Pure
/// functions, any thread. Where a value cannot be computed, an Error gives the reason: too few values, a value that is not finite, no
/// spread.
#pragma once
#include <span>

#include "engine/base/result.h"

namespace catena::statistics {

/// Pearson's correlation: r = sum (x - mean x)(y - mean y) / sqrt(sum (x - mean x)^2 sum (y - mean y)^2),
/// t = r sqrt((n - 2) / (1 - r^2)) with n - 2 degrees of freedom, p two-sided. The confidence interval [low, high] is Fisher's:
/// tanh(atanh r -+ z / sqrt(n - 3)); for n = 3 it is [-1, 1].
struct Correlation {
  int n = 0;
  double r = 0, t = 0, df = 0, p = 1;  ///< t is infinite where all points lie on a line
  double low = -1, high = 1;
};
/// Computes the correlation of x and y, which have the same size. Error: fewer than three pairs, or as above.
Result<Correlation> pearson(std::span<const double> x, std::span<const double> y, double confidence = 0.95);

/// Test of whether the correlations r(a, b) and r(c, d) of the same n subjects are equal: both in Fisher's z, with their covariance
/// estimated from all six correlations (T. E. Raghunathan, R. Rosenthal, D. B. Rubin, Psychological Methods 1 (1996), 178-183, their ZPF):
///   z = sqrt((n - 3) / 2) (atanh r_ab - atanh r_cd) / sqrt(1 - c),   c = k / (2 (1 - r_ab^2) (1 - r_cd^2)),
///   k = (r_ac - r_bc r_ab)(r_bd - r_bc r_cd) + (r_ad - r_ac r_cd)(r_bc - r_ac r_ab)
///     + (r_ac - r_ad r_cd)(r_bd - r_ad r_ab) + (r_ad - r_ab r_bd)(r_bc - r_bd r_cd)
struct CorrelationDifference {
  int n = 0;
  double first = 0, second = 0;  ///< r(a, b) and r(c, d)
  double z = 0, p = 1;           ///< p is two-sided
};
/// Compares r(a, b) with r(c, d); all four have the same size. Error: fewer than ten subjects, because z is only approximately normal, or
/// as above.
Result<CorrelationDifference> compare_correlations(std::span<const double> a, std::span<const double> b, std::span<const double> c,
                                                   std::span<const double> d);

/// The least-squares line y = intercept + slope x, which minimizes the squared residuals of y.
struct RegressionLine {
  double slope = 0, intercept = 0;
};
/// Fits the line. Error: fewer than two points, or all x equal.
Result<RegressionLine> regression(std::span<const double> x, std::span<const double> y);

}  // namespace catena::statistics
