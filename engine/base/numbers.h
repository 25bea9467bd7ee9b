// SPDX-License-Identifier: MIT
/// Numbers as text: printed such that they read back exactly, and parsed strictly (the whole text, decimal point, no locale). Any thread.
#pragma once
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace catena {

/// Returns the shortest text that reads back to the same double; "nan", "inf", "-inf" for values that are not finite.
std::string to_text(double value);
/// Appends the text of to_text(value) to `out`.
void append_number(std::string& out, double value);

/// Returns a number rounded for people, to `digits` significant digits: "1e20", "-9999", "0.1" for a 32-bit 0.1, never "-0". Integers of up
/// to ten digits are printed in full.
std::string format_readable(double value, int digits = 6);

/// Parses a double, finite or not; nullopt unless all of `text` is one number (blanks at its ends are allowed).
std::optional<double> parse_double(std::string_view text);
/// Parses a decimal integer; nullopt unless all of `text` is one (blanks at its ends are allowed).
std::optional<long long> parse_integer(std::string_view text);

/// Rounds a value to `digits` significant decimal digits.
double round_to_digits(double value, int digits);

/// Removes blanks, tabs and carriage returns from both ends.
std::string_view trim(std::string_view text);

/// Returns the q-quantile of a sample: element number floor(q n) of the sorted values, the largest for q = 1; 0 for an empty sample.
/// Reorders `values`.
template <class T>
T quantile(std::vector<T>& values, double q) {
  if (values.empty()) return T{};
  const auto k = std::min(values.size() - 1, static_cast<std::size_t>(q * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(k), values.end());
  return values[k];
}

/// Tick of a legend or axis, at a round number: steps are 1, 2 or 5 times a power of ten. Method: P. S. Heckbert, "Nice numbers for graph
/// labels", Graphics Gems (1990), 61-63; here only ticks in [lo, hi].
struct AxisTick {
  double value = 0;  ///< double nearest to the number in the label
  /// Text with the minimum number of digits that show the value exactly: the same number of decimals on all ticks, or an exponent on each.
  std::string label;
};

/// Returns about `about` (>= 2) ticks from lo to hi in ascending order: at least 0.6 (about - 1) and at most 1.5 (about - 1) + 1. Labels
/// are in fixed notation ("0.25", "1500") up to 6 digits, beyond that in the shorter of fixed and exponent notation ("2.5e-7"). lo > hi is
/// swapped. Returns one tick when lo and hi are equal or differ by less than 1e-12 of their size, and none when one is not finite.
std::vector<AxisTick> nice_ticks(double lo, double hi, int about = 5);

}  // namespace catena
