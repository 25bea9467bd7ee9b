/// The range of values that a picture shows where nobody states one: all values, unless a few outliers or a fill value lie far beyond the
/// others. One value of 1e20 among 0 .. 1 gives 0 .. 1.
///
/// The distinct values of a sample are sorted. The core is the shortest interval that holds half of them, known fill values (is_fill_value)
/// left out. It grows to the neighbouring value, the nearer first, until the gap g to all values D beyond one end is large by the length s
/// of the interval so far:
///   g >= 2 s    D holds known fill values only
///   g > 10 s    D holds, besides those, at most max(4, n / 10000) of n values (n / 64 where that is less than 4)
///   g > 50 s    D holds, besides those, a single value other than 0, and more than 8 different values are inside
///   g > 1e6 s   D holds at most a tenth of all values, each larger than 1e9 and 1e9 times larger than the values inside
/// Where all other values are equal (s = 0), D is beyond if it holds fill values only, or few values of 1e15 and more, 1e6 times larger.
/// Ordinary data, heavy tails included, have no such gap: their range is exactly the least and the greatest value.
/// Deterministic; any thread.
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace catena {

/// The range of values that a picture shows, and what lies beyond it.
struct DisplayRange {
  /// The values beyond one end.
  struct Outliers {
    std::uint64_t count = 0;           ///< 0: no value lies beyond this end
    double nearest = 0, farthest = 0;  ///< of them; equal: they all have this value
  };
  double lo = 0, hi = 0;              ///< what is shown
  double data_min = 0, data_max = 0;  ///< of all finite values
  std::uint64_t count = 0;            ///< finite values
  Outliers below{};                   ///< lo
  Outliers above{};                   ///< hi

  /// Whether values lie beyond either end.
  bool has_outliers() const { return below.count > 0 || above.count > 0; }
  /// Whether a value belongs to those shown.
  bool contains(double value) const {
    return std::isfinite(value) && (below.count == 0 || value > below.nearest) && (above.count == 0 || value < above.nearest);
  }
};

/// Whether files use the value for missing data: -999, -9999, -32768, 1e20, 9.96921e36 (NetCDF), the greatest float, ...
bool is_fill_value(float value);

/// Of a sample, by value (it is sorted); `least` and `most` are those of all values, of which the sample may have missed some. Values that
/// are not finite or outside least..most do not count. Counts are of the sample. Without a value: 0 .. 0.
DisplayRange display_range(std::vector<float> sample, double least, double most);
/// Makes the range of a sample that of all values: exact ends and counts. A value that the sample missed counts as beyond where it is
/// nearer to those than to the values shown, or 10 lengths of the range away from it.
class RangeCounter {
 public:
  /// Counts nothing yet.
  explicit RangeCounter(const DisplayRange& of_sample);
  /// A finite value; others do not count.
  void add(double value, std::uint64_t count = 1);
  /// Adds what another counter of the same sample has counted.
  void merge(const RangeCounter& part);
  /// Of all values that were added.
  DisplayRange range() const;

 private:
  DisplayRange counted_;
  double lower_fence_, upper_fence_;  ///< fences
};

/// Of all values.
DisplayRange display_range(std::span<const double> values);
/// The same of single precision.
DisplayRange display_range(std::span<const float> values);

/// "0 .. 1 (1 value of 1e20 beyond)"
std::string format_range(const DisplayRange& range);
/// A sentence without an end on what lies beyond, for notes; empty where nothing does. Of a value that many have: that it may mean missing
/// data.
std::string outlier_note(const DisplayRange& range);

}  // namespace catena
