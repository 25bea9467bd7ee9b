// SPDX-License-Identifier: MIT
/// Symmetric logarithmic scale, used for the values of a color map's control points and for positions along a color bar. With c =
/// linear_below > 0
///   s(v) = v / c                         |v| <= c
///   s(v) = sign(v) (1 + ln(|v| / c))     |v| > c
/// The scale and its slope are continuous. For values >= c it is a logarithm plus a constant, so a logarithmic scale is this scale with c =
/// the smallest value. linear_below = 0 means the linear scale, s(v) = v. Pure functions, any thread.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace catena {

/// Returns s(value).
inline double symlog(double value, double linear_below) {
  if (!(linear_below > 0)) return value;
  const double ratio = std::fabs(value) / linear_below;
  return ratio <= 1 ? value / linear_below : std::copysign(1 + std::log(ratio), value);
}

/// Returns the value v with s(v) = `coordinate`, a position on the scale.
inline double symlog_inverse(double coordinate, double linear_below) {
  if (!(linear_below > 0)) return coordinate;
  const double size = std::fabs(coordinate);
  return size <= 1 ? coordinate * linear_below : std::copysign(linear_below * std::exp(size - 1), coordinate);
}

/// Returns the value at the fraction t, 0 to 1, of the distance from lo to hi on the scale; exactly lo and hi at the ends.
inline double symlog_interpolate(double lo, double hi, double t, double linear_below) {
  if (t <= 0) return lo;
  if (t >= 1) return hi;
  const double a = symlog(lo, linear_below), b = symlog(hi, linear_below);
  return symlog_inverse((1 - t) * a + t * b, linear_below);
}

/// Resamples rows (value, ...) that are linear between each other on the scale such that they are linear in the value, by adding rows. The
/// error of each column is at most `share` times the largest absolute number of that column; at most 1024 segments replace one. A straight
/// segment over an interval of length h of s deviates by h^2 / 8 of the slope there.
template <std::size_t N>
std::vector<std::array<double, N>> refine_for_symlog(const std::vector<std::array<double, N>>& rows, double linear_below, double share) {
  constexpr double kMaxParts = 1024;
  if (!(linear_below > 0) || rows.size() < 2) return rows;
  std::array<double, N> maxima{};
  for (const auto& row : rows)
    for (std::size_t c = 1; c < N; ++c) maxima[c] = std::max(maxima[c], std::fabs(row[c]));
  std::vector<std::array<double, N>> out{rows.front()};
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto &a = rows[i - 1], &b = rows[i];
    double change = 0;
    for (std::size_t c = 1; c < N; ++c)
      if (maxima[c] > 0) change = std::max(change, std::fabs(b[c] - a[c]) / maxima[c]);
    const double length = symlog(b[0], linear_below) - symlog(a[0], linear_below);
    const double parts = std::clamp(std::ceil(std::sqrt(change * length / (8 * share))), 1.0, kMaxParts);
    for (double k = 1; k < parts; ++k) {
      std::array<double, N> row;
      row[0] = symlog_interpolate(a[0], b[0], k / parts, linear_below);
      for (std::size_t c = 1; c < N; ++c) row[c] = a[c] + k / parts * (b[c] - a[c]);
      if (row[0] > out.back()[0] && row[0] < b[0]) out.push_back(row);
    }
    out.push_back(b);
  }
  return out;
}

}  // namespace catena
