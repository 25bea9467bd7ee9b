// SPDX-License-Identifier: MIT
/// Automatic display range: the range of values that colors span when the user gives none. It contains all values, unless a few outliers or
/// a fill value (missing data) lie far outside of the others. One value of 1e20 among values from 0 to 1 gives the range 0 to 1.
///
/// The distinct values of a sample are sorted. The inlier interval starts as the shortest interval that contains half of them, known fill
/// values (is_fill_value) excluded. It grows to the nearer of its two neighboring values, one value at a time, until all values D outside
/// of one end are outliers. With g the gap to the nearest value of D and s the current length of the interval, D are outliers when
///   g >= 2 s    D contains known fill values only
///   g > 10 s    D contains, besides fill values, at most max(4, n / 10000) of n values (n / 64 instead of 4 where that is less)
///   g > 50 s    D contains, besides those, a single value other than 0, and more than 8 distinct values are in the interval
///   g > 1e6 s   D contains at most a tenth of all values, each > 1e9 in size and 1e9 times larger than the interval's values
/// When all other values are equal (s = 0), D are outliers if they are fill values only (not limits of integer types), or few values of
/// 1e15 and more that are 1e6 times larger. Ordinary data, heavy tails included, have no such gap: their range is exactly their minimum and
/// maximum. Deterministic; any thread.
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/base/export.h"

namespace catena {

/// Display range of a set of values and its outliers.
struct DisplayRange {
  /// Outliers below or above the range.
  struct Outliers {
    std::uint64_t count = 0;  ///< number of outliers; 0: none at this end
    double nearest = 0;       ///< outlier nearest to the range
    double farthest = 0;      ///< outlier farthest from it; equals `nearest` when all outliers have the same value
  };
  double lo = 0, hi = 0;              ///< displayed range
  double data_min = 0, data_max = 0;  ///< minimum and maximum of all finite values, outliers included
  std::uint64_t count = 0;            ///< number of finite values, outliers included
  Outliers below{};                   ///< outliers below lo
  Outliers above{};                   ///< outliers above hi

  /// Returns true when there are outliers below or above the range.
  bool has_outliers() const { return below.count > 0 || above.count > 0; }
  /// Returns true when a value is finite and not an outlier.
  bool contains(double value) const {
    return std::isfinite(value) && (below.count == 0 || value > below.nearest) && (above.count == 0 || value < above.nearest);
  }
};

/// Returns true for values that files commonly use for missing data: -999, -9999, -32768, 1e20, 9.96921e36 (NetCDF), the largest float, ...
CATENA_EXPORT bool is_fill_value(float value);

/// Returns the display range estimated from a sample, passed by value because it is sorted. `min_value` and `max_value` are the minimum and
/// maximum of all values; the sample may have missed them. Sample values that are not finite or outside of min_value..max_value are
/// ignored. Counts refer to the sample. Returns min_value..max_value without outliers when min_value < max_value does not hold.
CATENA_EXPORT DisplayRange display_range(std::vector<float> sample, double min_value, double max_value);
/// Refines the display range of a sample to the exact range and counts of all values. A value that the sample missed counts as an outlier
/// when it is nearer to the outliers than to the displayed values, or more than 10 lengths of the range away from it.
class CATENA_EXPORT RangeCounter {
 public:
  /// Starts with no values counted. `of_sample` is the display range of the sample.
  explicit RangeCounter(const DisplayRange& of_sample);
  /// Counts `count` occurrences of a value; a value that is not finite is ignored.
  void add(double value, std::uint64_t count = 1);
  /// Adds the counts of `part`, a counter that was made from the same sample.
  void merge(const RangeCounter& part);
  /// Returns the display range of all values that were added.
  DisplayRange range() const;

 private:
  DisplayRange counted_;
  /// Values below the first or above the second count as outliers; -infinity and infinity: no outliers at that end.
  double lower_fence_, upper_fence_;
};

/// Returns the exact display range of all finite values; 0 to 0 when there is none.
CATENA_EXPORT DisplayRange display_range(std::span<const double> values);
/// Returns the exact display range of all finite values, given in single precision; 0 to 0 when there is none.
CATENA_EXPORT DisplayRange display_range(std::span<const float> values);

/// Returns the range as text, for example "0 .. 1 (1 value of 1e20 beyond)".
CATENA_EXPORT std::string format_range(const DisplayRange& range);
/// Returns a note on the outliers, a sentence without a final period; empty when there are none. When many outliers share one value, the
/// note states that it may stand for missing data.
CATENA_EXPORT std::string outlier_note(const DisplayRange& range);

}  // namespace catena
