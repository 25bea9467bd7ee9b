// SPDX-License-Identifier: MIT
/// Statistics of a sample and of paired samples: mean and standard deviation, the paired t-test with its effect size, Holm's correction for
/// multiple tests. Units are those of the values. Pure functions, any thread; the same input gives the same bits. Where a value cannot be
/// computed, an Error gives the reason: too few values, a value that is not finite, no spread.
#pragma once
#include <span>
#include <vector>

#include "engine/base/result.h"

namespace catena::statistics {

/// Summary of n values x_i: mean = sum x_i / n, sd = sqrt(sum (x_i - mean)^2 / (n - 1)), and the half width of the mean's confidence
/// interval, t(1 - (1 - confidence) / 2; n - 1) sd / sqrt(n).
struct Summary {
  int n = 0;
  double mean = 0, sd = 0, half_width = 0;
  /// Lower end of the mean's confidence interval.
  double low() const { return mean - half_width; }
  /// Upper end of the mean's confidence interval.
  double high() const { return mean + half_width; }
};
/// Summarizes the values. Error: fewer than two, or as above.
Result<Summary> summarize(std::span<const double> values, double confidence = 0.95);

/// Paired t-test of pairs (a_i, b_i) with the differences d_i = a_i - b_i: t = mean(d) / (sd(d) / sqrt(n)) with n - 1 degrees of freedom, p
/// two-sided. The effect size is d_z = mean(d) / sd(d) = t / sqrt(n) (J. Cohen, Statistical Power Analysis for the Behavioral Sciences,
/// 1988, 2.3.5). Its confidence interval consists of those d_z for which the observed t lies between the tails of the noncentral t
/// distribution with delta = d_z sqrt(n) (D. Lakens, Frontiers in Psychology 4 (2013), 863).
struct PairedTest {
  int n = 0;
  double difference = 0;     ///< mean(a) - mean(b)
  double low = 0, high = 0;  ///< Confidence interval of the difference
  double sd = 0;             ///< Standard deviation of the differences
  double t = 0, df = 0, p = 1;
  /// Effect size d_z and its confidence interval.
  double effect = 0, effect_low = 0, effect_high = 0;
};
/// Tests a against b, which have the same size. Error: fewer than two pairs, or all differences equal up to round-off (no spread).
Result<PairedTest> paired_test(std::span<const double> a, std::span<const double> b, double confidence = 0.95);

/// p-values corrected for multiple testing, in the order of `p` (S. Holm, Scandinavian Journal of Statistics 6 (1979), 65-70): the k-th
/// smallest of m is multiplied by m - k + 1, is at least its predecessor, and at most 1. If values below alpha are called significant, the
/// probability of any false positive in the family is at most alpha, whatever the dependence between the tests.
std::vector<double> holm_correction(std::span<const double> p);

/// Error if a value is not finite or there are fewer than `min_count` values.
Outcome check_values(std::span<const double> values, int min_count);

}  // namespace catena::statistics
