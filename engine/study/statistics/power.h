// SPDX-License-Identifier: MIT
/// Power of a paired t-test, and the number of subjects needed for a given power. With n subjects and a true effect size d_z (mean of the
/// differences divided by their standard deviation), t has the noncentral t distribution with n - 1 degrees of freedom and
/// delta = d_z sqrt(n); power = P(|t| > the critical t of a two-sided test at alpha). (J. Cohen, Statistical Power Analysis for the
/// Behavioral Sciences, 1988.) Pure functions, any thread.
#pragma once
#include "engine/base/result.h"

namespace catena::statistics {

/// Power with `n` >= 2 subjects at significance level `alpha` in (0, 1). For effect = 0 it is alpha, the false positive rate.
double paired_power(double effect, int n, double alpha);

/// Largest number of subjects that required_subjects() tries.
inline constexpr int kMaxSubjects = 1'000'000;
/// Returns the smallest number of subjects with at least the power `power` in (0, 1). Error: kMaxSubjects are not enough.
Result<int> required_subjects(double effect, double power, double alpha);

}  // namespace catena::statistics
