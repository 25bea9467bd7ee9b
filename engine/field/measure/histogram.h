// SPDX-License-Identifier: MIT
/// Histogram of the values of a grid, with the bins of numpy.histogram: equal widths, edges lo + n (hi - lo) / bins, the lower edge of a
/// bin included, the upper one only in the last bin. Not for the haptic tick; any thread. Results do not depend on the number of threads.
#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/export.h"
#include "engine/field/measure/voxels.h"

namespace catena::field {

/// Counts of values in bins.
struct Histogram {
  std::vector<double> edges;           ///< one more than bins
  std::vector<std::uint64_t> counts;   ///< values in each bin
  std::uint64_t below = 0, above = 0;  ///< values outside of the range
  Moments values;                      ///< of all voxels that count, also those outside of the range
  LeftOut left_out;                    ///< voxels that do not count
};

/// Largest number of bins.
inline constexpr int kMaxHistogramBins = 1'000'000;

/// Counts the values. `range`: lowest and highest edge, lo <= hi; default: the range of the values. A range of no width is widened by 0.5
/// on both sides. Error (a message fragment): that of measurable_box(), the edges would not be finite, or two of
/// them would be equal.
CATENA_EXPORT Result<Histogram> make_histogram(const ScalarGrid& grid, int bins, std::optional<std::pair<double, double>> range = {});

}  // namespace catena::field
