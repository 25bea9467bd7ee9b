/// How often a paired t-test finds what is there, and how many subjects it needs for that. With n subjects and a true effect size d_z (mean
/// of the differences by their standard deviation) t has the noncentral t distribution with n - 1 degrees of freedom and
/// delta = d_z sqrt(n); power = P(|t| > the critical t of a two-sided test at alpha). (J. Cohen, Statistical Power Analysis for the
/// Behavioral Sciences, 1988.) Pure functions, any thread.
#pragma once
#include "engine/base/result.h"

namespace catena::statistics {

/// n >= 2; alpha in (0, 1). With effect = 0 it is alpha, the share of false findings.
double paired_power(double effect, int n, double alpha);

inline constexpr int kMaxSubjects = 1'000'000;
/// The fewest subjects with at least that power; an error where kMaxSubjects are not enough. power in (0, 1).
Result<int> required_subjects(double effect, double power, double alpha);

}  // namespace catena::statistics
