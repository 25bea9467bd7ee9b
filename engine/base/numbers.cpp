// SPDX-License-Identifier: MIT
#include "engine/base/numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "engine/base/result.h"

namespace catena {

void append_number(std::string& out, double value) {
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  out.append(buffer, end);
}

std::string to_text(double value) {
  std::string out;
  append_number(out, value);
  return out;
}

std::string format_readable(double value, int digits) {
  constexpr double kMaxWritten = 1e10, kMaxFixedSize = 1e7, kMinFixedSize = 1e-4;
  if (!std::isfinite(value) || value == 0) return to_text(value + 0.0);
  const double rounded = round_to_digits(value, digits), size = std::fabs(rounded);
  if (value == std::floor(value) && std::fabs(value) < kMaxWritten && (size < kMaxFixedSize || rounded != value))
    return fmt::format("{:.0f}", value);
  char buffer[40];
  const bool fixed = size >= kMinFixedSize && size < kMaxFixedSize;
  const auto format = fixed ? std::chars_format::fixed : std::chars_format::scientific;
  const std::string text(buffer, std::to_chars(buffer, buffer + sizeof buffer, rounded, format).ptr);
  const std::size_t e = text.find('e');
  // shortens "1e+20" to "1e20", "2e-07" to "2e-7"
  return fixed ? text : text.substr(0, e) + "e" + std::to_string(std::atoi(text.c_str() + e + 1));
}

double round_to_digits(double value, int digits) {
  return std::isfinite(value) ? parse_double(fmt::format("{:.{}g}", value, digits)).value_or(value) : value;
}

std::string_view trim(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

namespace {
template <class T>
std::optional<T> parse(std::string_view text) {
  text = trim(text);
  if (text.size() > 1 && text.front() == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
  T value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc{} || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}
}  // namespace

std::optional<double> parse_double(std::string_view text) {
  if (const auto value = parse<double>(text)) return value;
  // from_chars rejects numbers that are too small for a double; they become zero or subnormal
  text = trim(text);
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc::result_out_of_range || end != text.data() + text.size()) return std::nullopt;
  value = std::strtod(std::string(text).c_str(), nullptr);
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}
std::optional<long long> parse_integer(std::string_view text) { return parse<long long>(text); }

namespace {

constexpr double kNoRange = 1e-12, kSlack = 1e-9;
constexpr std::size_t kMaxFixed = 6;

/// Number mantissa * 10^exponent; the mantissa is 1, 2, 5 or 10.
struct Step {
  int mantissa = 1, exponent = 0;
  double value() const { return mantissa * std::pow(10.0, exponent); }
};

/// Returns the Step nearest to x > 0.
Step nice(double x) {
  int exponent = static_cast<int>(std::floor(std::log10(x)));
  const double fraction = x / std::pow(10.0, exponent);
  return {fraction < 1.5 ? 1 : fraction < 3 ? 2 : fraction < 7 ? 5 : 10, exponent};
}

/// Formats count * 10^exponent without an exponent, with -exponent decimals.
std::string fixed_text(long long count, int exponent) {
  std::string digits = std::to_string(std::llabs(count));
  if (exponent >= 0) {
    if (count != 0) digits.append(static_cast<std::size_t>(exponent), '0');
  } else {
    const auto decimals = static_cast<std::size_t>(-exponent);
    if (digits.size() <= decimals) digits.insert(0, decimals + 1 - digits.size(), '0');
    digits.insert(digits.size() - decimals, ".");
  }
  return (count < 0 ? "-" : "") + digits;
}

/// Formats count * 10^exponent with one digit before the decimal point and an exponent: "2.5e-7".
std::string exponent_text(long long count, int exponent) {
  if (count == 0) return "0";
  std::string digits = std::to_string(std::llabs(count));
  exponent += static_cast<int>(digits.size()) - 1;
  while (digits.size() > 1 && digits.back() == '0') digits.pop_back();
  if (digits.size() > 1) digits.insert(1, ".");
  return (count < 0 ? "-" : "") + digits + "e" + std::to_string(exponent);
}

/// Returns the largest number of digits in a label.
std::size_t max_digits(const std::vector<std::string>& labels) {
  std::size_t maximum = 0;
  for (const std::string& label : labels)
    maximum =
        std::max(maximum, static_cast<std::size_t>(std::count_if(label.begin(), label.end(), [](char c) { return c >= '0' && c <= '9'; })));
  return maximum;
}

}  // namespace

std::vector<AxisTick> nice_ticks(double lo, double hi, int about) {
  CATENA_ASSERT(about >= 2);
  if (!std::isfinite(lo) || !std::isfinite(hi)) return {};
  if (lo > hi) std::swap(lo, hi);
  const double size = std::max(std::fabs(lo), std::fabs(hi));
  // halved: the difference of two large numbers must not overflow
  const double half = 0.5 * hi - 0.5 * lo;
  if (!(half > 0.5 * kNoRange * size) || !(half > 1e-300)) return {{lo, to_text(lo)}};

  const Step step = nice(half / (0.5 * std::max(2, about - 1)));
  const double unit = step.value();
  const auto first = static_cast<long long>(std::ceil(lo / unit - kSlack)), last = static_cast<long long>(std::floor(hi / unit + kSlack));
  int exponent = step.exponent, mantissa = step.mantissa;
  if (mantissa == 10) ++exponent, mantissa = 1;
  std::vector<std::string> fixed, scientific;
  const bool readable = std::abs(exponent) <= 40;
  for (long long k = first; k <= last; ++k) {
    if (readable) fixed.push_back(fixed_text(k * mantissa, exponent));
    scientific.push_back(exponent_text(k * mantissa, exponent));
  }
  const std::size_t digits = max_digits(fixed);
  const bool uses_fixed = readable && (digits <= kMaxFixed || digits <= max_digits(scientific));
  const std::vector<std::string>& labels = uses_fixed ? fixed : scientific;
  std::vector<AxisTick> ticks;
  for (const std::string& label : labels) ticks.push_back({parse_double(label).value_or(0), label});
  return ticks;
}

}  // namespace catena
