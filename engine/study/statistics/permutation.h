/// PairedComparison differences without the assumption that they are normally distributed: were the two conditions alike, each difference
/// would have come with either sign equally often. p is the share of all 2^n choices of signs whose sum is at least as far from 0 as the
/// one seen (R. A. Fisher, The Design of Experiments, 1935, section 21). Sums within 1e-12 of the sum of |d| count as the same.
///   n <= 32   exact: all choices are counted, from the sorted sums of the two halves, 2^(n/2) each
///   above     m = 10,000 choices by a seeded generator (above 2,000 differences fewer: 20 million signs in all, at least 100 choices), and
///             the one seen: p = (1 + as far) / (1 + m) (B. Phipson and G. K. Smyth, Statistical Applications in Genetics and Molecular
///             Biology 9 (2010), 39); the same seed gives the same p
/// Pure, any thread.
#pragma once
#include <cstdint>
#include <span>

#include "engine/base/result.h"

namespace catena::statistics {

struct SignFlipTest {
  double p = 1;
  bool exact = true;
  double sign_patterns = 0;  ///< of signs that were counted
};

/// Two differences at least, all finite.
Result<SignFlipTest> sign_flip_test(std::span<const double> differences, std::uint64_t seed = 1);

inline constexpr std::size_t kMaxExactFlips = 32;

}  // namespace catena::statistics
