// SPDX-License-Identifier: MIT
#include "engine/base/display_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "engine/base/numbers.h"

namespace catena {
namespace {

constexpr double kFillGap = 2, kFewGap = 10, kSpikeGap = 50, kWildGap = 1e6;  // in lengths of the interval so far
constexpr double kWildShare = 0.1, kWildSize = 1e9, kHugeSize = 1e15, kHugeRatio = 1e6;
constexpr std::size_t kMaxSampled = 1u << 20;
constexpr std::size_t kMinInside = 8;  // fewer distinct values may be materials
constexpr std::uint64_t kFewValues = 4, kFewDivisor = 10000, kSmallDivisor = 64;
constexpr double kManyShare = 0.001;  // fraction of the values from which a single repeated value may be a fill value

struct DistinctValue {
  double value;
  std::uint64_t count;
  bool fill;
};

/// Limits of integer types. They also occur as ordinary data values.
constexpr std::array<float, 6> kIntegerFills{-32768.f, -32767.f, 32767.f, 65535.f, -2147483648.f, 2147483648.f};

bool is_integer_fill(double value) {
  return std::ranges::any_of(kIntegerFills, [&](float fill) { return value == static_cast<double>(fill); });
}

std::vector<DistinctValue> distinct_values(const std::vector<float>& sorted) {
  std::vector<DistinctValue> distinct;
  for (const float v : sorted) {
    if (distinct.empty() || distinct.back().value != static_cast<double>(v)) distinct.push_back({v, 0, is_fill_value(v)});
    ++distinct.back().count;
  }
  return distinct;
}

/// Grows an interval of distinct values from the inlier interval that find_core() returns.
class RangeSearch {
 public:
  explicit RangeSearch(const std::vector<DistinctValue>& values) : values_(values) {
    for (const DistinctValue& v : values_) all_ += v.count;
    few_ = std::max(std::min(kFewValues, all_ / kSmallDivisor), all_ / kFewDivisor);
    find_core();
  }

  void grow() {
    while (grow_once()) {
    }
  }
  std::size_t first() const { return first_; }
  std::size_t last() const { return last_; }

 private:
  void find_core() {
    std::vector<std::size_t> inner;
    for (std::size_t i = 0; i < values_.size(); ++i)
      if (!values_[i].fill) inner.push_back(i);
    if (inner.empty())
      for (std::size_t i = 0; i < values_.size(); ++i) inner.push_back(i);
    const std::size_t half_count = (inner.size() + 1) / 2 - 1;
    double shortest = std::numeric_limits<double>::infinity();
    std::uint64_t best_count = 0;
    for (std::size_t i = 0; i + half_count < inner.size(); ++i) {
      const double length = values_[inner[i + half_count]].value - values_[inner[i]].value;
      const std::uint64_t count = values_[inner[i]].count;
      if (length > shortest || (length == shortest && count <= best_count)) continue;
      shortest = length;
      best_count = count;
      first_ = inner[i];
      last_ = inner[i + half_count];
    }
  }

  /// Extends the interval by one value; returns false if only outliers are left.
  bool grow_once() {
    const bool can_extend_down = first_ > 0, can_extend_up = last_ + 1 < values_.size();
    const double down = can_extend_down ? values_[first_].value - values_[first_ - 1].value : 0,
                 up = can_extend_up ? values_[last_ + 1].value - values_[last_].value : 0;
    const bool down_first = can_extend_down && (!can_extend_up || down <= up);
    for (const bool downward : {down_first, !down_first}) {
      if (!(downward ? can_extend_down : can_extend_up)) continue;
      if (is_beyond(downward, downward ? down : up)) continue;
      downward ? --first_ : ++last_;
      return true;
    }
    return false;
  }

  bool is_beyond(bool low, double gap) const {
    const double length = values_[last_].value - values_[first_].value;
    if (length > 0 && gap < kFillGap * length) return false;
    const auto begin = low ? values_.begin() : values_.begin() + static_cast<std::ptrdiff_t>(last_ + 1);
    const auto end = low ? values_.begin() + static_cast<std::ptrdiff_t>(first_) : values_.end();
    std::uint64_t others = 0, spike = 0, all = 0;
    bool integers = false;
    for (auto it = begin; it != end; ++it) {
      all += it->count;
      integers = integers || is_integer_fill(it->value);
      if (it->fill) continue;
      others += it->count;
      if (it->value != 0) spike = std::max(spike, it->count);
    }
    const double nearest = std::fabs(low ? (end - 1)->value : begin->value);
    const double inside = std::max(std::fabs(values_[first_].value), std::fabs(values_[last_].value));
    if (!(length > 0)) return (others == 0 && !integers) || (others <= few_ && nearest >= kHugeSize && nearest >= kHugeRatio * inside);
    if (others == 0) return gap >= kFillGap * length;
    if (others <= few_ && gap > kFewGap * length) return true;
    if (others - spike <= few_ && spike > 0 && last_ - first_ >= kMinInside && gap > kSpikeGap * length) return true;
    return static_cast<double>(all) <= kWildShare * static_cast<double>(all_) && nearest >= kWildSize && nearest >= kWildSize * inside &&
           gap > kWildGap * length;
  }

  const std::vector<DistinctValue>& values_;
  std::uint64_t all_ = 0, few_ = 0;
  std::size_t first_ = 0, last_ = 0;
};

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Returns the boundary between the last value in the range and the first outlier.
double fence(double inner, double outlier, double length) {
  const double half = 0.5 * inner + 0.5 * outlier, distance = kFewGap * length;
  if (!(length > 0)) return half;
  return outlier > inner ? std::min(half, inner + distance) : std::max(half, inner - distance);
}

void add_outlier(DisplayRange::Outliers& outliers, double value, std::uint64_t count, bool low) {
  if (outliers.count == 0) outliers.nearest = outliers.farthest = value;
  outliers.nearest = low ? std::max(outliers.nearest, value) : std::min(outliers.nearest, value);
  outliers.farthest = low ? std::min(outliers.farthest, value) : std::max(outliers.farthest, value);
  outliers.count += count;
}

template <class T>
DisplayRange range_of_all(std::span<const T> values) {
  const std::size_t step = 1 + values.size() / kMaxSampled;
  std::vector<float> sample;
  double minimum = kNone, maximum = -kNone;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const T v = values[i];
    if (!std::isfinite(v)) continue;
    minimum = std::min(minimum, static_cast<double>(v));
    maximum = std::max(maximum, static_cast<double>(v));
    if (i % step == 0) sample.push_back(static_cast<float>(v));
  }
  if (minimum > maximum) return {};
  RangeCounter counter(display_range(std::move(sample), minimum, maximum));
  for (const T v : values) counter.add(static_cast<double>(v));
  return counter.range();
}

std::string count_text(const DisplayRange::Outliers& outliers, std::string_view noun) {
  if (outliers.nearest == outliers.farthest)
    return fmt::format("{}{} of {}", outliers.count,
                       noun.empty()          ? ""
                       : outliers.count == 1 ? " value"
                                             : " values",
                       format_readable(outliers.nearest));
  return fmt::format("{}{} of {} to {}", outliers.count, noun.empty() ? "" : " values",
                     format_readable(std::min(outliers.nearest, outliers.farthest)),
                     format_readable(std::max(outliers.nearest, outliers.farthest)));
}

std::string outlier_text(const DisplayRange& range) {
  if (range.below.count > 0 && range.above.count > 0)
    return count_text(range.below, "values") + " below, " + count_text(range.above, "") + " above";
  return count_text(range.below.count > 0 ? range.below : range.above, "values") + " beyond";
}

}  // namespace

RangeCounter::RangeCounter(const DisplayRange& of_sample)
    : counted_{kNone, -kNone, of_sample.data_min, of_sample.data_max, 0, {}, {}}, lower_fence_(-kNone), upper_fence_(kNone) {
  const double length = of_sample.hi - of_sample.lo;
  if (of_sample.below.count > 0) lower_fence_ = fence(of_sample.lo, of_sample.below.nearest, length);
  if (of_sample.above.count > 0) upper_fence_ = fence(of_sample.hi, of_sample.above.nearest, length);
}

void RangeCounter::add(double value, std::uint64_t count) {
  if (!std::isfinite(value)) return;
  counted_.count += count;
  if (value < lower_fence_) return add_outlier(counted_.below, value, count, true);
  if (value > upper_fence_) return add_outlier(counted_.above, value, count, false);
  counted_.lo = std::min(counted_.lo, value);
  counted_.hi = std::max(counted_.hi, value);
}

void RangeCounter::merge(const RangeCounter& part) {
  counted_.count += part.counted_.count;
  counted_.lo = std::min(counted_.lo, part.counted_.lo);
  counted_.hi = std::max(counted_.hi, part.counted_.hi);
  for (const auto side : {&DisplayRange::below, &DisplayRange::above}) {
    const DisplayRange::Outliers& outliers = part.counted_.*side;
    if (outliers.count == 0) continue;
    add_outlier(counted_.*side, outliers.nearest, outliers.count, side == &DisplayRange::below);
    add_outlier(counted_.*side, outliers.farthest, 0, side == &DisplayRange::below);
  }
}

DisplayRange RangeCounter::range() const { return counted_; }

bool is_fill_value(float value) {
  constexpr float kNetcdf = 9.9692099683868690e+36f;
  for (const float below : {-999.f, -999.25f, -9999.f, -99999.f, -999999.f, -9999999.f})
    if (value == below) return true;
  const float size = std::fabs(value);
  for (const float either :
       {1e15f, 1e20f, 1e30f, 1e31f, 1e32f, 1e33f, 1e34f, 1e35f, 1e36f, 1e37f, 1e38f, kNetcdf, std::numeric_limits<float>::max()})
    if (size == either) return true;
  return is_integer_fill(value);
}

DisplayRange display_range(std::vector<float> sample, double min_value, double max_value) {
  DisplayRange range{min_value, max_value, min_value, max_value, 0, {}, {}};
  std::erase_if(sample, [&](float v) { return !std::isfinite(v) || v < min_value || v > max_value; });
  range.count = sample.size();
  if (!std::isfinite(min_value) || !std::isfinite(max_value) || !(min_value < max_value)) return range;
  sample.push_back(static_cast<float>(min_value));
  sample.push_back(static_cast<float>(max_value));
  std::ranges::sort(sample);
  const std::vector<DistinctValue> values = distinct_values(sample);
  RangeSearch search(values);
  search.grow();
  const std::size_t first = search.first(), last = search.last();
  for (std::size_t i = 0; i < first; ++i) range.below.count += values[i].count;
  for (std::size_t i = last + 1; i < values.size(); ++i) range.above.count += values[i].count;
  if (first > 0) range.lo = values[first].value, range.below.nearest = values[first - 1].value, range.below.farthest = values.front().value;
  if (last + 1 < values.size())
    range.hi = values[last].value, range.above.nearest = values[last + 1].value, range.above.farthest = values.back().value;
  return range;
}

DisplayRange display_range(std::span<const double> values) { return range_of_all(values); }
DisplayRange display_range(std::span<const float> values) { return range_of_all(values); }

std::string format_range(const DisplayRange& range) {
  const std::string text = format_readable(range.lo) + " .. " + format_readable(range.hi);
  return range.has_outliers() ? text + " (" + outlier_text(range) + ")" : text;
}

std::string outlier_note(const DisplayRange& range) {
  constexpr std::uint64_t kFewValues = 10;  // minimum count at which outliers of one value are reported as a possible code for missing data
  if (!range.has_outliers()) return {};
  std::string text = fmt::format("{} the others, {} .. {}, which colours span where no range is stated", outlier_text(range),
                                 format_readable(range.lo), format_readable(range.hi));
  for (const DisplayRange::Outliers& outliers : {range.below, range.above}) {
    const double fraction = static_cast<double>(outliers.count) / static_cast<double>(std::max<std::uint64_t>(range.count, 1));
    if (outliers.count == 0 || outliers.nearest != outliers.farthest) continue;
    if (fraction >= kManyShare && outliers.count >= kFewValues)
      text += fmt::format("; {:.3g} % of the values are exactly {}: perhaps missing data, which a mask (\"valid\") leaves out",
                          100 * fraction, format_readable(outliers.nearest));
    else if (is_fill_value(static_cast<float>(outliers.nearest)))
      text += fmt::format("; {} often stands for missing data", format_readable(outliers.nearest));
  }
  return text;
}

}  // namespace catena
