#include "render/extract/bar_ticks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace catena::render {
namespace {

constexpr int kFromExponent = 5, kToExponent = -4;  // numbers of that size get a common factor
constexpr double kSlack = 1e-9;

/// The multiples of a nice step that lie within lo .. hi; `step` is set.
std::vector<double> nice_values(double lo, double hi, int count, double& step) {
  const double raw = (hi - lo) / std::max(1, count - 1), power = std::pow(10.0, std::floor(std::log10(raw)));
  const double fraction = raw / power;
  step = power * (fraction < 1.5 ? 1 : fraction < 3.5 ? 2 : fraction < 7.5 ? 5 : 10);
  std::vector<double> values;
  for (double k = std::ceil(lo / step - kSlack); k <= std::floor(hi / step + kSlack); ++k) values.push_back(k * step);
  return values;
}

/// With a minus sign as typeset.
std::string typeset(std::string text) {
  for (std::size_t at = 0; (at = text.find('-', at)) != std::string::npos;) text.replace(at, 1, "\u2212");
  return text;
}

std::string formatted(const std::string& format, double value) {
  const std::size_t at = format.find('%'), kind = format.find_first_of("efg", at);
  const int precision = format[at + 1] == '.' ? std::stoi(format.substr(at + 2, kind - at - 2)) : 6;
  const char* number = format[kind] == 'e' ? "%.*e" : format[kind] == 'f' ? "%.*f" : "%.*g";
  char text[512];
  std::snprintf(text, sizeof text, number, precision, value);
  return format.substr(0, at) + typeset(text) + format.substr(kind + 1);
}

std::string superscript(int n) {
  static const char* const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = n < 0 ? "⁻" : "";
  for (const char c : std::to_string(std::abs(n))) text += digits[c - '0'];
  return text;
}

}  // namespace

BarScale bar_scale(double lo, double hi, int count, const std::string& format) {
  BarScale scale;
  if (!std::isfinite(lo) || !std::isfinite(hi)) return scale;
  if (!(hi - lo > 1e-12 * std::max(std::fabs(lo), std::fabs(hi))) || !std::isfinite(hi - lo)) {
    scale.ticks.push_back({lo, formatted(format.empty() ? "%.6g" : format, lo)});
    return scale;
  }
  double step = 1;
  const std::vector<double> values = nice_values(lo, hi, count, step);
  if (!format.empty()) {
    for (const double v : values) scale.ticks.push_back({v, formatted(format, v)});
    return scale;
  }
  double most = 0;
  for (const double v : values) most = std::max(most, std::fabs(v));
  int exponent = most > 0 ? static_cast<int>(std::floor(std::log10(most) + kSlack)) : 0;
  if (exponent < kFromExponent && exponent > kToExponent) exponent = 0;
  const int decimals = std::clamp(exponent - static_cast<int>(std::floor(std::log10(step) + kSlack)), 0, 15);
  for (const double v : values)
    scale.ticks.push_back({v, formatted("%." + std::to_string(decimals) + "f", v / std::pow(10.0, exponent) + 0.0)});
  if (exponent != 0) scale.factor = "×10" + superscript(exponent);
  return scale;
}

}  // namespace catena::render
