#include "render/extract/bar_ticks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/base/ticks.h"

namespace catena::render {
namespace {

constexpr int kFromExponent = 5, kToExponent = -4;  // numbers of that size get a common factor
constexpr double kSlack = 1e-9;

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
  // nice steps are coarse: rather a few ticks more than too few
  std::vector<Tick> ticks = nice_ticks(lo, hi, count);
  for (int about = count + 1; about <= 2 * count && static_cast<int>(ticks.size()) + 1 < count; ++about) ticks = nice_ticks(lo, hi, about);
  if (!format.empty() || ticks.size() < 2) {
    for (const Tick& tick : ticks) scale.ticks.push_back({tick.value, formatted(format.empty() ? "%.6g" : format, tick.value)});
    return scale;
  }
  const double step = ticks[1].value - ticks[0].value;
  double most = 0;
  for (const Tick& tick : ticks) most = std::max(most, std::fabs(tick.value));
  int exponent = most > 0 ? static_cast<int>(std::floor(std::log10(most) + kSlack)) : 0;
  if (exponent < kFromExponent && exponent > kToExponent) exponent = 0;
  const int decimals = std::clamp(exponent - static_cast<int>(std::floor(std::log10(step) + kSlack)), 0, 15);
  for (const Tick& tick : ticks)
    scale.ticks.push_back({tick.value, formatted("%." + std::to_string(decimals) + "f", tick.value / std::pow(10.0, exponent) + 0.0)});
  if (exponent != 0) scale.factor = "×10" + superscript(exponent);
  return scale;
}

}  // namespace catena::render
