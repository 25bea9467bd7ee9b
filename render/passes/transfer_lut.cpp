#include "render/passes/transfer_lut.h"

#include <algorithm>
#include <cmath>

namespace catena::render {
namespace {

constexpr std::uint32_t kEntries = 4096;

template <class Points>
double piecewise(const Points& points, double value, std::size_t column) {
  if (points.empty()) return 0;
  const auto above = std::upper_bound(points.begin(), points.end(), value, [](double v, const auto& p) { return v < p[0]; });
  if (above == points.begin()) return points.front()[column];
  if (above == points.end()) return points.back()[column];
  const auto& a = *(above - 1);
  const auto& b = *above;
  const double f = (value - a[0]) / (b[0] - a[0]);
  return a[column] + f * (b[column] - a[column]);
}

}  // namespace

double table_value(const TransferTable& table, double value, int channel) {
  return channel == 3 ? piecewise(table.extinctions, value, 1) : piecewise(table.colors, value, std::size_t(channel) + 1);
}

TransferLut make_transfer_lut(const TransferTable& table, const BrickRange& range) {
  // the values where anything changes
  double lo = range.least, hi = range.greatest, first = HUGE_VAL, last = -HUGE_VAL;
  for (const auto& p : table.colors) first = std::min(first, p[0]), last = std::max(last, p[0]);
  for (const auto& p : table.extinctions) first = std::min(first, p[0]), last = std::max(last, p[0]);
  if (first <= last) {
    lo = std::clamp(lo, first, last);
    hi = std::clamp(hi, first, last);
  }
  TransferLut lut;
  lut.lo = float(lo);
  lut.per_value = hi > lo ? float((kEntries - 1) / (hi - lo)) : 0;
  if (!std::isfinite(lut.per_value)) lut.per_value = 0;
  lut.entries.resize(lut.per_value > 0 ? kEntries : 2);
  for (std::uint32_t i = 0; i < lut.entries.size(); ++i) {
    const double value = lut.per_value > 0 ? lo + (hi - lo) * i / (kEntries - 1) : lo;
    for (int c = 0; c < 4; ++c) lut.entries[i][c] = float(table_value(table, value, c));
  }
  lut.visible_before.resize(lut.entries.size() + 1);
  for (std::size_t i = 0; i < lut.entries.size(); ++i) lut.visible_before[i + 1] = lut.visible_before[i] + (lut.entries[i].a > 0);
  return lut;
}

bool TransferLut::visible(const BrickRange& range) const {
  const auto index = [this](float value) { return std::clamp((value - lo) * per_value, 0.0f, float(last())); };
  const auto from = std::uint32_t(std::floor(index(range.least))), to = std::uint32_t(std::ceil(index(range.greatest)));
  return visible_before[to + 1] > visible_before[from];
}

}  // namespace catena::render
