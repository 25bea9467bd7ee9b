// SPDX-License-Identifier: MIT
#include "render/raycast/transfer_tables.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/result.h"
#include "engine/base/symlog_scale.h"

namespace catena::render {

namespace {

constexpr std::uint32_t kEntries = 4096;
constexpr double kMaxEntryIds = 7000;   // maximum number of distinct entries that are numbered, for skipping homogeneous bricks
constexpr double kMaxLabels = 1 << 18;  // maximum number of labels with an entry each
/// Share of an interval within which rounding may move a value into the adjacent interval.
constexpr double kPositionRounding = 1.0 / 256;

float nearest_below(double value) {
  const auto f = float(value);
  return double(f) > value ? std::nextafter(f, -HUGE_VALF) : f;
}
float nearest_above(double value) {
  const auto f = float(value);
  return double(f) < value ? std::nextafter(f, HUGE_VALF) : f;
}

/// Returns the function's points as floats, or the adjacent floats of a point that is none; the function is linear between them.
std::vector<float> float_points(const TransferTable& table, double lo, double hi) {
  std::vector<float> values;
  for (const double value : control_values_between(table, lo, hi))
    for (const float f : {nearest_below(value), nearest_above(value)}) values.push_back(f);
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

glm::vec4 look_of(const TransferTable& table, double value) {
  glm::vec4 look;
  for (int c = 0; c < 4; ++c) look[c] = float(table_value(table, value, c));
  return look;
}

/// Factor of the allowed error for rare values, relative to frequent ones.
struct Allowance {
  double sigma = 1, color = 1;
};

bool errs(const glm::vec4& exact, const glm::vec4& read, bool colors_alone, double length, const Allowance& allowed) {
  const double depth = double(exact.a) * length, share = colors_alone ? 1 : std::min(1.0, depth);
  if (std::fabs(double(exact.a) - read.a) * length > kTableTolerance * allowed.sigma * (1 + depth)) return true;
  for (int c = 0; c < 3; ++c)
    if (std::fabs(double(exact[c]) - read[c]) * share > kTableTolerance * allowed.color) return true;
  return false;
}

/// Returns the fractional sample index of a value, in double precision.
double index_of(const TransferLut& lut, double value) {
  return std::clamp((symlog(value, lut.linear_below) - double(lut.lo)) * double(lut.entries_per_unit), 0.0, double(lut.last_index()));
}

std::size_t interval_of(const TransferLut& lut, double coordinate) {
  return std::size_t(std::clamp(std::floor(coordinate), 0.0, double(lut.last_index()) - 1));
}

/// Returns the allowance of each interval by the count of values in it.
std::vector<Allowance> allowances(const TransferLut& lut, std::span<const float> values) {
  constexpr double kMaxSigmaWeight = 16, kMaxColorWeight = 4;
  std::vector<Allowance> all(lut.last_index());
  if (values.empty()) return all;
  std::vector<std::uint32_t> counts(lut.last_index(), 1);
  for (const float value : values)
    if (std::isfinite(value)) ++counts[interval_of(lut, index_of(lut, value))];
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double rare = kRareValueShare * double(values.size()) / counts[i];
    all[i] = {std::clamp(rare, 1.0, kMaxSigmaWeight), std::clamp(rare, 1.0, kMaxColorWeight)};
  }
  return all;
}

/// Marks the intervals whose interpolated samples err at a point of the function, by a negative alpha; returns whether any is marked.
bool mark_intervals(TransferLut& lut, bool colors_alone, double length, std::span<const float> values) {
  std::vector<std::uint8_t> marked(lut.last_index());
  const std::vector<Allowance> allowed = allowances(lut, values);
  for (std::size_t i = 0; i < lut.control_values.size(); ++i) {
    const double coordinate = index_of(lut, lut.control_values[i]);
    const std::size_t cell = interval_of(lut, coordinate);
    const auto f = float(coordinate - double(cell));
    const glm::vec4 read = lut.entries[cell] * (1 - f) + lut.entries[cell + 1] * f;
    if (!errs(lut.control_points[i], read, colors_alone, length, allowed[cell])) continue;
    for (const double side : {-kPositionRounding, kPositionRounding}) marked[interval_of(lut, coordinate + side)] = 1;
  }
  for (std::size_t i = 0; i < marked.size(); ++i)
    if (marked[i] != 0) lut.entries[i].a = -lut.entries[i].a;
  return std::ranges::find(marked, 1) != marked.end();
}

/// Counts visible entries and runs of equal entries, among the control points or the samples.
void number_looks(TransferLut& lut) {
  const std::vector<glm::vec4>& all = lut.has_control_points() ? lut.control_points : lut.entries;
  lut.visible_prefix.resize(all.size() + 1);
  for (std::size_t i = 0; i < all.size(); ++i) lut.visible_prefix[i + 1] = lut.visible_prefix[i] + (all[i].a > 0);
  lut.run_ids.resize(all.size());
  for (std::size_t i = 1; i < all.size(); ++i) lut.run_ids[i] = lut.run_ids[i - 1] + (all[i] != all[i - 1]);
}

}  // namespace

double table_value(const TransferTable& table, double value, int channel) {
  return channel == 3 ? interpolate_piecewise(table.extinctions, value, 1)
                      : interpolate_piecewise(table.colors, value, std::size_t(channel) + 1);
}

std::vector<double> control_values_between(const TransferTable& table, double lo, double hi) {
  std::vector<double> values{lo, hi};
  const auto add = [&](const auto& points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double value = points[i][0];
      if (!(value > lo && value < hi)) continue;
      values.push_back(value);
      if (i + 1 < points.size() && points[i + 1][0] == value) values.push_back(std::nextafter(value, lo));
    }
  };
  add(table.colors);
  add(table.extinctions);
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

TransferLut make_transfer_lut(const TransferTable& table, const BrickRange& range, double length, std::span<const float> values) {
  // the range of values in which the function varies
  double lo = range.min, hi = range.max, first = HUGE_VAL, last = -HUGE_VAL;
  for (const auto& p : table.colors) first = std::min(first, p[0]), last = std::max(last, p[0]);
  for (const auto& p : table.extinctions) first = std::min(first, p[0]), last = std::max(last, p[0]);
  if (first <= last && !table.is_categorical) {
    lo = std::clamp(lo, first, last);
    hi = std::clamp(hi, first, last);
  }
  std::uint32_t count = kEntries;
  const double first_label = std::floor(lo + 0.5), labels = std::ceil(hi - 0.5) - first_label + 1;
  const bool each_label = table.is_categorical && labels >= 2 && labels <= kMaxLabels;
  if (each_label) {
    count = std::uint32_t(labels);
    lo = first_label;
    hi = first_label + labels - 1;
  }
  TransferLut lut;
  lut.linear_below = each_label ? 0 : table.linear_below;
  // a range of one sign: the scale differs only by a constant, which would cost a float's precision
  if (lut.linear_below > 0 && (lo > 0 || hi < 0)) lut.linear_below = std::max(lut.linear_below, std::min(std::fabs(lo), std::fabs(hi)));
  // over less than a factor of about 1.6, a float logarithm resolves fewer values than the values themselves
  if (lut.has_nonlinear_scale() && symlog(hi, lut.linear_below) - symlog(lo, lut.linear_below) < 0.5) lut.linear_below = 0;
  const double from = symlog(lo, lut.linear_below), to = symlog(hi, lut.linear_below);
  lut.lo = float(from);
  lut.entries_per_unit = to > from ? float((count - 1) / (to - from)) : 0;
  if (!std::isfinite(lut.entries_per_unit)) lut.entries_per_unit = 0;
  if (!(lut.entries_per_unit > 0)) count = 2;
  for (std::uint32_t i = 0; i < count; ++i)
    lut.entries.push_back(look_of(
        table, lut.entries_per_unit > 0 ? symlog_inverse(double(lut.lo) + i / double(lut.entries_per_unit), lut.linear_below) : lo));
  if (!each_label && hi > lo) {
    lut.control_values = float_points(table, lo, hi);
    for (const float value : lut.control_values) lut.control_points.push_back(look_of(table, value));
    if (!mark_intervals(lut, table.extinctions.empty(), length, values)) {
      lut.control_values.clear();
      lut.control_points.clear();
    }
  }
  number_looks(lut);
  return lut;
}

TransferLut make_gradient_factor_lut(const std::vector<std::array<double, 2>>& factors) {
  CATENA_ASSERT(!factors.empty());
  TransferTable table;
  for (const auto& [gradient, factor] : factors) table.colors.push_back({gradient, factor, 0, 0});
  return make_transfer_lut(table, {float(factors.front()[0]), float(factors.back()[0])}, 0);
}

std::vector<glm::vec4> TransferLut::pack_for_shader() const {
  std::vector<glm::vec4> all = entries;
  all.insert(all.end(), control_points.begin(), control_points.end());
  const std::size_t start = all.size();
  all.resize(start + (control_values.size() + 3) / 4);
  for (std::size_t i = 0; i < control_values.size(); ++i) all[start + i / 4][int(i % 4)] = control_values[i];
  return all;
}

float TransferLut::sample_index(float value) const {
  return std::clamp((float(symlog(value, linear_below)) - lo) * entries_per_unit, 0.0f, float(last_index()));
}

float TransferLut::index(float value) const {
  if (!has_control_points()) return sample_index(value);
  const auto after = std::clamp(std::ranges::upper_bound(control_values, value), control_values.begin() + 1, control_values.end() - 1);
  const float a = after[-1], b = *after;
  return float(after - control_values.begin() - 1) + std::clamp((value - a) / (b - a), 0.0f, 1.0f);
}

bool TransferLut::any_visible(const BrickRange& range) const {
  const auto from = std::uint32_t(std::floor(index(range.min))), to = std::uint32_t(std::ceil(index(range.max)));
  return visible_prefix[to + 1] > visible_prefix[from];
}

std::uint16_t TransferLut::appearance(const BrickRange& range) const {
  if (!any_visible(range)) return 1;
  if (double(run_ids.size()) > kMaxEntryIds) return 0;
  const auto from = std::size_t(std::floor(index(range.min))), to = std::size_t(std::ceil(index(range.max)));
  if (run_ids[from] == run_ids[to]) return std::uint16_t(2 + run_ids[from]);
  // a single value between two different entries
  constexpr float parts = 8;
  static_assert(2 + kMaxEntryIds + parts * kMaxEntryIds < 65536 && kEntries < kMaxEntryIds);
  const float coordinate = sample_index(range.min);
  const bool marked = std::signbit(entries[std::min(std::size_t(coordinate), std::size_t(last_index()) - 1)].a);
  if (range.min != range.max || marked) return 0;
  return std::uint16_t(2 + run_ids.size() + std::size_t(std::lround(parts * coordinate)));
}

}  // namespace catena::render
