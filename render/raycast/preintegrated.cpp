// SPDX-License-Identifier: MIT
#include "render/raycast/preintegrated.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "render/raycast/transfer_tables.h"

namespace catena::render {

namespace {

constexpr int kCodes = 256, kSamplesPerCode = 16;  // number of codes; samples per code
constexpr double kMissedShare = 0.1;               // share of a peak or gap that samples may miss

/// Extinction sigma, and sigma * (red, green, blue).
using Appearance = std::array<double, 4>;

Appearance appearance_at(const TransferTable& table, double value) {
  const double sigma = table_value(table, value, 3);
  if (!(sigma > 0)) return {};
  return {sigma, sigma * table_value(table, value, 0), sigma * table_value(table, value, 1), sigma * table_value(table, value, 2)};
}

std::uint32_t quantised(double share, double max_sample) { return std::uint32_t(std::lround(std::clamp(share, 0.0, 1.0) * max_sample)); }

std::array<std::uint32_t, 2> entry(const Appearance& mean) {
  if (!(mean[0] > 0)) return {};
  return {std::bit_cast<std::uint32_t>(float(mean[0])),
          quantised(mean[1] / mean[0], 2047) | quantised(mean[2] / mean[0], 2047) << 11 | quantised(mean[3] / mean[0], 1023) << 22};
}

/// Returns whether evenly spaced samples from lo to hi, linearly interpolated, resolve each peak and gap of the function: within one sample
/// spacing of each of its points, they reach its value up to kMissedShare of the larger of it and its neighbors.
bool takes_peaks(const TransferTable& table, double lo, double hi, int samples) {
  const double width = (hi - lo) / double(samples - 1);
  const auto takes = [&](const auto& points, std::size_t i, int channel, std::size_t component) {
    const double center = points[i][component], before = std::floor((points[i][0] - lo) / width) - 1;
    double min_sample = HUGE_VAL, max_sample = -HUGE_VAL;
    for (int k = 0; k < 4; ++k) {
      const double sample = table_value(table, std::clamp(lo + (before + k) * width, lo, hi), channel);
      min_sample = std::min(min_sample, sample);
      max_sample = std::max(max_sample, sample);
    }
    const double beside = std::max(points[i > 0 ? i - 1 : i][component], points[std::min(i + 1, points.size() - 1)][component]);
    const double near = kMissedShare * std::max(center, beside);
    return center >= min_sample - near && center <= max_sample + near;
  };
  const auto takes_all = [&](const auto& points, int first_channel) {
    for (std::size_t i = 0; i < points.size(); ++i)
      for (std::size_t c = 1; c < points[i].size() && points[i][0] > lo && points[i][0] < hi; ++c)
        if (!takes(points, i, first_channel + int(c) - 1, c)) return false;
    return true;
  };
  return takes_all(table.colors, 0) && takes_all(table.extinctions, 3);
}

}  // namespace

ValueInterval active_interval(const TransferTable& table, const ValueInterval& values, bool shaded) {
  if (!(values.min < values.max)) return values;
  const std::vector<double> points = control_values_between(table, values.min, values.max);
  std::vector<Appearance> looks;
  for (const double value : points) looks.push_back(appearance_at(table, value));
  std::size_t first = 0, final = points.size() - 1;
  const auto trims = [&](const Appearance& end) { return !shaded || !(end[0] > 0); };
  while (trims(looks.front()) && first < final && looks[first + 1] == looks.front()) ++first;
  while (trims(looks.back()) && final > first && looks[final - 1] == looks.back()) --final;
  return {points[first], points[final]};
}

double quantization_change(const TransferTable& table, const ValueInterval& active, std::span<const float> values, double length) {
  if (!(active.min < active.max) || values.empty()) return 0;
  const double per_code = (active.max - active.min) / (kCodes - 1);
  const auto shown = [&](double value) {
    Appearance entry_appearance = appearance_at(table, value);
    const double alpha = -std::expm1(-entry_appearance[0] * length), share = entry_appearance[0] > 0 ? alpha / entry_appearance[0] : 0;
    entry_appearance[0] = alpha;
    for (int c = 1; c < 4; ++c) entry_appearance[c] *= share;
    return entry_appearance;
  };
  double sum = 0;
  for (const float raw : values) {
    const double value = std::clamp(double(raw), active.min, active.max);
    const Appearance exact = shown(value), rounded = shown(active.min + per_code * std::round((value - active.min) / per_code));
    double change = 0;
    for (int c = 0; c < 4; ++c) change = std::max(change, std::fabs(exact[c] - rounded[c]));
    sum += change;
  }
  return sum / double(values.size());
}

bool resolves_transfer_function(const TransferTable& table, const ValueInterval& active) {
  return !(active.min < active.max) || takes_peaks(table, active.min, active.max, (kCodes - 1) * kSamplesPerCode + 1);
}

namespace {

/// Part between two consecutive codes: mean, and whether the function is constant on it.
struct Piece {
  Appearance integral{};
  bool level = true;
  double greatest_sigma = 0;
};

/// Integrates exactly by Simpson's rule: sigma and color are linear between the function's points, their product is quadratic.
Piece piece_between(const TransferTable& table, double from, double to) {
  Piece piece;
  if (!(from < to)) return piece;
  const std::vector<double> values = control_values_between(table, from, to);
  Appearance before = appearance_at(table, from);
  for (std::size_t i = 1; i < values.size(); ++i) {
    const Appearance middle = appearance_at(table, 0.5 * (values[i - 1] + values[i])), after = appearance_at(table, values[i]);
    for (int c = 0; c < 4; ++c)
      piece.integral[c] += (before[c] + 4 * middle[c] + after[c]) / 6 * ((values[i] - values[i - 1]) / (to - from));
    piece.level = piece.level && before == middle && middle == after;
    piece.greatest_sigma = std::max({piece.greatest_sigma, before[0], after[0]});
    before = after;
  }
  return piece;
}

}  // namespace

PreintegratedTable make_preintegrated(const TransferTable& table, double lo, double per_code, bool shaded) {
  std::array<Appearance, kCodes> looks{}, integral{};
  std::array<bool, kCodes> alike{};  // the function is constant (shaded: and zero) between the code and the next
  PreintegratedTable out;
  for (int a = 0; a < kCodes; ++a) {
    looks[a] = appearance_at(table, lo + per_code * a);
    out.max_sigma = std::max(out.max_sigma, looks[a][0]);
    if (a == 0) continue;
    const Piece piece = piece_between(table, lo + per_code * (a - 1), lo + per_code * a);
    for (int c = 0; c < 4; ++c) integral[a][c] = integral[a - 1][c] + piece.integral[c];
    alike[a - 1] = piece.level && (!shaded || !(looks[a - 1][0] > 0));
    out.max_sigma = std::max(out.max_sigma, piece.greatest_sigma);
    out.appearance.appearance_id[a] = std::uint16_t(out.appearance.appearance_id[a - 1] + (alike[a - 1] ? 0 : 1));
  }
  const auto mean = [&](int a, int b) {
    Appearance m;
    for (int c = 0; c < 4; ++c) m[c] = std::max(0.0, (integral[b][c] - integral[a][c]) / (b - a));
    return m;
  };

  out.entries.resize(std::size_t(kCodes) * kCodes);
  for (int a = 0; a < kCodes; ++a) {
    out.appearance.is_invisible[a] = !(looks[a][0] > 0);
    out.entries[std::size_t(a) * kCodes + a] = entry(looks[a]);
    for (int b = a + 1; b < kCodes; ++b) {
      const bool same = out.appearance.appearance_id[a] == out.appearance.appearance_id[b];
      out.entries[std::size_t(a) * kCodes + b] = out.entries[std::size_t(b) * kCodes + a] = entry(same ? looks[a] : mean(a, b));
    }
  }
  return out;
}

}  // namespace catena::render
