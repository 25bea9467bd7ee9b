// SPDX-License-Identifier: MIT
/// Threshold by value: objects are shown only where their values lie in one of at most two closed ranges, for instance in two tails of a
/// statistic. Pure functions, any thread.
#pragma once
#include <algorithm>
#include <array>
#include <vector>

namespace catena {

/// Ranges [lowest, highest] of the values that are shown, rising and apart; empty: all values.
using Threshold = std::vector<std::array<double, 2>>;
inline constexpr std::size_t kMaxThresholdRanges = 2;  ///< Maximum number of ranges

/// Returns whether a value is shown. NaN is shown without a threshold only.
inline bool is_within(const Threshold& threshold, double value) {
  return threshold.empty() || std::ranges::any_of(threshold, [&](const auto& r) { return value >= r[0] && value <= r[1]; });
}

}  // namespace catena
