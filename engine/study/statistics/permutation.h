// SPDX-License-Identifier: MIT
/// Sign-flip permutation test of paired differences, without the assumption that they are normally distributed: if the two conditions were
/// equal, each difference would have either sign equally often. p is the fraction of all 2^n sign patterns whose sum is at least as far
/// from 0 as the observed one (R. A. Fisher, The Design of Experiments, 1935, section 21). Sums within 1e-12 of the sum of |d| count as
/// equal.
///   n <= 32   exact: all patterns are counted, from the sorted sums of the two halves, 2^(n/2) each
///   n > 32    m = 10,000 patterns from a seeded generator (above 2,000 differences fewer: 20 million signs in all, but at least 100
///             patterns), plus the observed one: p = (1 + count of sums as far from 0) / (1 + m) (B. Phipson and G. K. Smyth, Statistical
///             Applications in Genetics and Molecular Biology 9 (2010), 39); the same seed gives the same p
/// Pure, any thread.
#pragma once
#include <cstdint>
#include <span>

#include "engine/base/result.h"

namespace catena::statistics {

/// Result of sign_flip_test().
struct SignFlipTest {
  /// Two-sided p-value.
  double p = 1;
  /// All sign patterns were counted; false: a random sample of them.
  bool exact = true;
  double sign_patterns = 0;  ///< Number of sign patterns that were counted
};

/// Tests whether the mean of `differences` is 0. `seed`: of the generator, for n > kMaxExactFlips. Error: fewer than two differences, one
/// that is not finite, or a sum that overflows.
Result<SignFlipTest> sign_flip_test(std::span<const double> differences, std::uint64_t seed = 1);

/// Largest number of differences that is tested exactly.
inline constexpr std::size_t kMaxExactFlips = 32;

}  // namespace catena::statistics
