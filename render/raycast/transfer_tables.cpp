#include "render/raycast/transfer_tables.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/base/result.h"

namespace catena::render {

namespace {

constexpr std::uint32_t kEntries = 4096;
/// Of labels, with extinctions (whose looks are numbered) and without.
constexpr double kMostLooks = 7000, kMostLabelColors = 1 << 18;
constexpr double kMissed = 0.1;  // of what samples may miss of a peak or a gap

}  // namespace

double table_value(const TransferTable& table, double value, int channel) {
  return channel == 3 ? piecewise(table.extinctions, value, 1) : piecewise(table.colors, value, std::size_t(channel) + 1);
}

namespace {

/// The values of the function's points from lo to hi, and these two; where the function leaps, the one just before, too.
std::vector<double> points_between(const TransferTable& table, double lo, double hi) {
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

}  // namespace

bool is_sampled(const TransferTable& table, double lo, double hi, std::size_t samples) {
  const double width = (hi - lo) / double(samples - 1);
  const auto takes = [&](const auto& points, std::size_t i, int channel, std::size_t component) {
    const double own = points[i][component], before = std::floor((points[i][0] - lo) / width) - 1;
    double least = HUGE_VAL, greatest = -HUGE_VAL;
    for (int k = 0; k < 4; ++k) {
      const double sample = table_value(table, std::clamp(lo + (before + k) * width, lo, hi), channel);
      least = std::min(least, sample);
      greatest = std::max(greatest, sample);
    }
    const double beside = std::max(points[i > 0 ? i - 1 : i][component], points[std::min(i + 1, points.size() - 1)][component]);
    const double near = kMissed * std::max(own, beside);
    return own >= least - near && own <= greatest + near;
  };
  const auto takes_all = [&](const auto& points, int first_channel) {
    for (std::size_t i = 0; i < points.size(); ++i)
      for (std::size_t c = 1; c < points[i].size() && points[i][0] > lo && points[i][0] < hi; ++c)
        if (!takes(points, i, first_channel + int(c) - 1, c)) return false;
    return true;
  };
  return takes_all(table.colors, 0) && takes_all(table.extinctions, 3);
}

TransferLut make_transfer_lut(const TransferTable& table, const BrickRange& range) {
  // the values where anything changes
  double lo = range.least, hi = range.greatest, first = HUGE_VAL, last = -HUGE_VAL;
  for (const auto& p : table.colors) first = std::min(first, p[0]), last = std::max(last, p[0]);
  for (const auto& p : table.extinctions) first = std::min(first, p[0]), last = std::max(last, p[0]);
  if (first <= last && !table.labels) {
    lo = std::clamp(lo, first, last);
    hi = std::clamp(hi, first, last);
  }
  std::uint32_t count = kEntries;
  const double first_label = std::floor(lo + 0.5), labels = std::ceil(hi - 0.5) - first_label + 1;
  if (table.labels && labels >= 2 && labels <= (table.extinctions.empty() ? kMostLabelColors : kMostLooks)) {
    count = std::uint32_t(labels);
    lo = first_label;
    hi = first_label + labels - 1;
  }
  TransferLut lut;
  lut.lo = float(lo);
  lut.per_value = hi > lo ? float((count - 1) / (hi - lo)) : 0;
  if (!std::isfinite(lut.per_value)) lut.per_value = 0;
  std::vector<double> points;
  if (count == kEntries && hi > lo && !is_sampled(table, lo, hi, kEntries)) points = points_between(table, lo, hi);
  if (!points.empty() && points.size() <= kEntries) {
    lut.per_value = -1;
    lut.values.assign(points.begin(), points.end());
  } else {
    points.resize(lut.per_value > 0 ? count : 2);
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = lut.per_value > 0 ? lo + (hi - lo) * double(i) / (count - 1) : lo;
  }
  lut.entries.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int c = 0; c < 4; ++c) lut.entries[i][c] = float(table_value(table, points[i], c));
  lut.visible_before.resize(lut.entries.size() + 1);
  for (std::size_t i = 0; i < lut.entries.size(); ++i) lut.visible_before[i + 1] = lut.visible_before[i] + (lut.entries[i].a > 0);
  lut.run.resize(lut.entries.size());
  for (std::size_t i = 1; i < lut.entries.size(); ++i) lut.run[i] = std::uint16_t(lut.run[i - 1] + (lut.entries[i] != lut.entries[i - 1]));
  return lut;
}

std::vector<glm::vec4> TransferLut::words() const {
  std::vector<glm::vec4> all = entries;
  all.resize(entries.size() + (values.size() + 3) / 4);
  for (std::size_t i = 0; i < values.size(); ++i) all[entries.size() + i / 4][int(i % 4)] = values[i];
  return all;
}

float TransferLut::index(float value) const {
  if (!uneven()) return std::clamp((value - lo) * per_value, 0.0f, float(last()));
  const auto after = std::clamp(std::ranges::upper_bound(values, value), values.begin() + 1, values.end() - 1);
  const float a = after[-1], b = *after;
  return float(after - values.begin() - 1) + (b > a ? std::clamp((value - a) / (b - a), 0.0f, 1.0f) : 1.0f);
}

bool TransferLut::visible(const BrickRange& range) const {
  const auto from = std::uint32_t(std::floor(index(range.least))), to = std::uint32_t(std::ceil(index(range.greatest)));
  return visible_before[to + 1] > visible_before[from];
}

std::uint16_t TransferLut::look(const BrickRange& range) const {
  if (!visible(range)) return 1;
  const float least = index(range.least), greatest = index(range.greatest);
  const auto from = std::size_t(std::floor(least)), to = std::size_t(std::ceil(greatest));
  if (run[from] == run[to]) return std::uint16_t(2 + run[from]);
  // one value between two different entries
  constexpr float parts = 8;
  static_assert(2 + kMostLooks + parts * kMostLooks < 65536 && kEntries < kMostLooks);
  return range.least == range.greatest ? std::uint16_t(2 + entries.size() + std::size_t(std::lround(parts * least))) : 0;
}

FactorLut make_factor_lut(const std::vector<std::array<double, 2>>& factors) {
  constexpr std::size_t entries = 1024;
  CATENA_ASSERT(!factors.empty());
  const double lo = factors.front()[0], hi = factors.back()[0];
  FactorLut lut;
  lut.lo = float(lo);
  lut.per_gradient = hi > lo ? float((entries - 1) / (hi - lo)) : 0;
  for (std::size_t i = 0; i < entries; ++i)
    lut.entries.emplace_back(float(piecewise(factors, lo + (hi - lo) * double(i) / (entries - 1), 1)), 0, 0, 0);
  return lut;
}

namespace {

constexpr int kCodes = 256, kFine = 16;  // samples a code
constexpr int kSamples = (kCodes - 1) * kFine + 1;

/// sigma, and sigma times red, green, blue.
using Look = std::array<double, 4>;

Look look_at(const TransferTable& table, double value) {
  const double sigma = table_value(table, value, 3);
  if (!(sigma > 0)) return {};
  return {sigma, sigma * table_value(table, value, 0), sigma * table_value(table, value, 1), sigma * table_value(table, value, 2)};
}

std::uint32_t quantised(double share, double greatest) { return std::uint32_t(std::lround(std::clamp(share, 0.0, 1.0) * greatest)); }

std::array<std::uint32_t, 2> entry(const Look& mean) {
  if (!(mean[0] > 0)) return {};
  return {std::bit_cast<std::uint32_t>(float(mean[0])),
          quantised(mean[1] / mean[0], 2047) | quantised(mean[2] / mean[0], 2047) << 11 | quantised(mean[3] / mean[0], 1023) << 22};
}

}  // namespace

ValueInterval active_interval(const TransferTable& table, const ValueInterval& values, bool shaded) {
  if (!(values.least < values.greatest)) return values;
  const std::vector<double> points = points_between(table, values.least, values.greatest);
  std::vector<Look> looks;
  for (const double value : points) looks.push_back(look_at(table, value));
  std::size_t first = 0, final = points.size() - 1;
  const auto trims = [&](const Look& end) { return !shaded || !(end[0] > 0); };
  while (trims(looks.front()) && first < final && looks[first + 1] == looks.front()) ++first;
  while (trims(looks.back()) && final > first && looks[final - 1] == looks.back()) --final;
  return {points[first], points[final]};
}

bool is_packed_whole(const TransferTable& table, const ValueInterval& active) {
  return !(active.least < active.greatest) || is_sampled(table, active.least, active.greatest, kSamples);
}

PreintegratedTable make_preintegrated(const TransferTable& table, double lo, double per_code, bool shaded) {
  // running integrals by the trapezium rule
  std::vector<Look> looks(kSamples), integral(kSamples);
  PreintegratedTable out;
  for (int k = 0; k < kSamples; ++k) {
    looks[k] = look_at(table, lo + per_code * k / kFine);
    out.greatest_sigma = std::max(out.greatest_sigma, looks[k][0]);
    if (k > 0)
      for (int c = 0; c < 4; ++c) integral[k][c] = integral[k - 1][c] + 0.5 * (looks[k - 1][c] + looks[k][c]);
  }
  const auto mean = [&](int a, int b) {
    Look m;
    for (int c = 0; c < 4; ++c) m[c] = std::max(0.0, (integral[b][c] - integral[a][c]) / (b - a));
    return m;
  };

  // runs of codes between which nothing changes
  std::array<bool, kCodes> alike{};  // code and the next
  for (int a = 0; a + 1 < kCodes; ++a) {
    alike[a] = !shaded || !(looks[a * kFine][0] > 0);
    for (int k = a * kFine; k < (a + 1) * kFine && alike[a]; ++k) alike[a] = looks[k] == looks[k + 1];
    out.looks.look[a + 1] = std::uint16_t(out.looks.look[a] + (alike[a] ? 0 : 1));
  }

  out.entries.resize(std::size_t(kCodes) * kCodes);
  for (int a = 0; a < kCodes; ++a) {
    out.looks.invisible[a] = !(looks[a * kFine][0] > 0);
    out.entries[std::size_t(a) * kCodes + a] = entry(looks[a * kFine]);
    for (int b = a + 1; b < kCodes; ++b) {
      const bool same = out.looks.look[a] == out.looks.look[b];
      out.entries[std::size_t(a) * kCodes + b] = out.entries[std::size_t(b) * kCodes + a] =
          entry(same ? looks[a * kFine] : mean(a * kFine, b * kFine));
    }
  }
  return out;
}

}  // namespace catena::render
