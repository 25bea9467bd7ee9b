/// The distributions that tests and intervals are read off: Student's t, the noncentral t, the normal and the beta distribution, by
/// Boost.Math. Pure functions, any thread.
#pragma once

namespace catena::statistics {

/// P(|T| >= |t|) with `df` > 0 degrees of freedom; 0 for an infinite t.
double two_sided_p(double t, double df);
/// The t that T stays below with this probability, in (0, 1).
double t_quantile(double probability, double df);
double normal_quantile(double probability);
/// P(|Z| >= |z|) of the standard normal distribution.
double two_sided_normal_p(double z);

/// P(T <= t) and P(T > t) where T = (Z + delta) / sqrt(V / df): Z standard normal, V chi-squared with df degrees of freedom.
double noncentral_t_cdf(double t, double df, double delta);
double noncentral_t_survival(double t, double df, double delta);

/// The delta for which P(T <= t) is this probability. To 1e-9 of its size; for |t| > 200 without the share of Z in T (to 1e-3).
double solve_noncentrality(double t, double df, double probability);

/// The interval of a share of which `hits` of `n` were seen, by the beta distribution (C. J. Clopper and E. S. Pearson, Biometrika 26
/// (1934), 404-413): it holds the true share in at least `confidence` of all samples. 0 <= hits <= n, n >= 1.
struct Interval {
  double low = 0, high = 0;
  bool contains(double x) const { return low <= x && x <= high; }
};
Interval proportion_interval(double hits, double n, double confidence);

}  // namespace catena::statistics
