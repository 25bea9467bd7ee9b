/// What a sample says of its mean, and one measure against another over the same subjects: mean and deviation, the paired t-test with its
/// effect size, Holm's correction for many tests. Units are those of the values. Pure functions, any thread; the same input gives the same
/// bits. NumberArray that cannot be had are an Error that says why in a sentence: too few values, a value that is not finite, no spread.
#pragma once
#include <span>
#include <vector>

#include "engine/base/result.h"

namespace catena::statistics {

/// Of n values x_i: mean = sum x_i / n, sd = sqrt(sum (x_i - mean)^2 / (n - 1)), and the half width of the mean's confidence interval,
/// t(1 - (1 - confidence) / 2; n - 1) sd / sqrt(n).
struct Summary {
  int n = 0;
  double mean = 0, sd = 0, half_width = 0;
  double low() const { return mean - half_width; }
  double high() const { return mean + half_width; }
};
/// Two values at least.
Result<Summary> summarize(std::span<const double> values, double confidence = 0.95);

/// Of pairs (a_i, b_i) with the differences d_i = a_i - b_i: t = mean(d) / (sd(d) / sqrt(n)) with n - 1 degrees of freedom, p two-sided.
/// The effect size is d_z = mean(d) / sd(d) = t / sqrt(n) (J. Cohen, Statistical Power Analysis for the Behavioral Sciences, 1988, 2.3.5);
/// its interval holds those d_z under which the seen t lies between the tails of the noncentral t distribution with delta = d_z sqrt(n)
/// (D. Lakens, Frontiers in Psychology 4 (2013), 863).
struct PairedTest {
  int n = 0;
  double difference = 0;     ///< mean(a) - mean(b)
  double low = 0, high = 0;  ///< its confidence interval
  double sd = 0;             ///< of the differences
  double t = 0, df = 0, p = 1;
  double effect = 0, effect_low = 0, effect_high = 0;
};
/// Two pairs at least; an error, too, where all differences are the same up to round-off: then there is no spread to measure with.
Result<PairedTest> paired_test(std::span<const double> a, std::span<const double> b, double confidence = 0.95);

/// p-values corrected for their number, in the order given (S. Holm, Scandinavian Journal of Statistics 6 (1979), 65-70): the k-th smallest
/// of m is multiplied by m - k + 1, is at least its predecessor, and at most 1. Whoever calls significant what is below alpha is wrong
/// about any test of the family with a probability of at most alpha, whatever the tests have to do with each other.
std::vector<double> holm_correction(std::span<const double> p);

/// Fine where all are finite and there are at least `least`; else the sentence.
Outcome check_values(std::span<const double> values, int least);

}  // namespace catena::statistics
