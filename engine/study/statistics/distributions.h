// SPDX-License-Identifier: MIT
/// Distribution functions for tests and confidence intervals: Student's t, the noncentral t, the normal and the beta distribution, from
/// Boost.Math. Pure functions, any thread. Arguments are not checked; a result outside the domain is NaN.
#pragma once

namespace catena::statistics {

/// P(|T| >= |t|) of Student's t distribution with `df` > 0 degrees of freedom; 0 for an infinite t.
double two_sided_p(double t, double df);
/// The t for which P(T <= t) = `probability`, in (0, 1), for Student's t distribution with `df` degrees of freedom.
double t_quantile(double probability, double df);
/// The z for which P(Z <= z) = `probability`, in (0, 1), for the standard normal distribution.
double normal_quantile(double probability);
/// P(|Z| >= |z|) of the standard normal distribution.
double two_sided_normal_p(double z);

/// P(T <= t) and P(T > t) for T = (Z + delta) / sqrt(V / df): Z standard normal, V chi-squared with df degrees of freedom.
double noncentral_t_cdf(double t, double df, double delta);
double noncentral_t_survival(double t, double df, double delta);

/// The delta for which P(T <= t) = `probability`, to a relative accuracy of 1e-9. For |t| > 200 the contribution of Z to T is neglected
/// (relative accuracy 1e-3).
double solve_noncentrality(double t, double df, double probability);

/// Closed interval [low, high].
struct Interval {
  double low = 0, high = 0;
  bool contains(double x) const { return low <= x && x <= high; }
};
/// Confidence interval of a proportion of which `hits` of `n` were observed, from the beta distribution (C. J. Clopper and E. S. Pearson,
/// Biometrika 26 (1934), 404-413): it contains the true proportion in at least the fraction `confidence` of all samples.
/// 0 <= hits <= n, n >= 1.
Interval proportion_interval(double hits, double n, double confidence);

}  // namespace catena::statistics
