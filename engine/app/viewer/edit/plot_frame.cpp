#include "engine/app/viewer/edit/plot_frame.h"

#include <algorithm>
#include <cmath>

namespace catena::app {

namespace {
constexpr double kNarrowest = 1e-12;  // of the values' size
constexpr double kWidest = 1e300;
}  // namespace

double PlotFrame::x_of(double value) const {
  const double share = (value - lo) / (hi - lo);
  return left + (std::isfinite(share) ? share : 0) * (right - left);
}

double PlotFrame::value_at(double x) const {
  const double share = right > left ? std::clamp((x - left) / (right - left), 0.0, 1.0) : 0;
  return share >= 1 ? hi : std::clamp(lo + share * (hi - lo), lo, hi);
}

double PlotFrame::y_of(double alpha) const { return bottom + std::sqrt(std::clamp(alpha, 0.0, 1.0)) * (top - bottom); }

double PlotFrame::alpha_at(double y) const {
  const double share = bottom > top ? std::clamp((bottom - y) / (bottom - top), 0.0, 1.0) : 0;
  return share * share;
}

std::array<double, 2> plot_range(double lo, double hi) {
  if (!std::isfinite(lo) || !std::isfinite(hi)) {
    if (std::isfinite(lo)) return plot_range(lo, lo);
    if (std::isfinite(hi)) return plot_range(hi, hi);
    return {0, 1};
  }
  lo = std::clamp(lo, -kWidest, kWidest), hi = std::clamp(hi, -kWidest, kWidest);
  if (lo > hi) std::swap(lo, hi);
  const double size = std::max(std::fabs(lo), std::fabs(hi));
  if (hi - lo > kNarrowest * size) return {lo, hi};
  const double half = size > 0 ? 0.5 * size : 0.5, middle = 0.5 * lo + 0.5 * hi;
  return {middle - half, middle + half};
}

double rounded_in(double value, double lo, double hi, double parts) {
  const double span = std::fabs(hi - lo);
  if (!std::isfinite(value) || !std::isfinite(span) || !(span > 0)) return value;
  const int digits = static_cast<int>(std::floor(std::log10(span / parts)));
  // division by a power of ten gives the double nearest to the short decimal, multiplication does not
  const double step = std::pow(10.0, std::abs(digits));
  const double n = std::round(digits < 0 ? value * step : value / step);
  const double rounded = digits < 0 ? n / step : n * step;
  return std::isfinite(rounded) ? rounded : value;
}

}  // namespace catena::app
