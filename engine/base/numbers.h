/// NumberArray as text: printed so that they read back exactly, read strictly (the whole word, decimal point, no locale).
#pragma once
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace catena {

/// The shortest text that reads back to the same double; "nan", "inf", "-inf" for those.
std::string to_text(double value);
void append_number(std::string& out, double value);

/// As people read it, not exactly: about so many digits, "1e20", "-9999", "0.1" for a 32-bit 0.1, never "-0". Whole numbers of up to ten
/// digits are written out.
std::string format_readable(double value, int digits = 6);

/// A finite or non-finite double; nothing if `text` (blanks at its ends allowed) is not wholly a number.
std::optional<double> parse_double(std::string_view text);
std::optional<long long> parse_integer(std::string_view text);

/// The double nearest to the value with so many decimal digits.
double round_to_digits(double value, int digits);

std::string_view trim(std::string_view text);

/// The q-quantile of a sample: the element number floor(q n) of the sorted values, the largest for q = 1; 0 of none.
/// Reorders `values`.
template <class T>
T quantile(std::vector<T>& values, double q) {
  if (values.empty()) return T{};
  const auto k = std::min(values.size() - 1, static_cast<std::size_t>(q * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(k), values.end());
  return values[k];
}

/// Ticks at nice numbers, for legends and axes: steps of 1, 2 or 5 times a power of ten.
/// P. S. Heckbert, "Nice numbers for graph labels", Graphics Gems (1990), 61-63; here only the ticks within [lo, hi].
/// Pure functions, any thread.
struct AxisTick {
  double value = 0;   ///< the double nearest to what the label says
  std::string label;  ///< as few digits as tell it exactly: as many decimals on every tick, or each with its exponent
};

/// About `about` (at least 2) ticks from lo to hi, rising: 0.6 (about - 1) at least, 1.5 (about - 1) + 1 at most. Labels are fixed ("0.25",
/// "1500") up to 6 digits, beyond that what is shorter of fixed and "2.5e-7". lo > hi is taken the other way round; one tick with its
/// shortest label where they are equal or differ by less than 1e-12 of their size; none where one is not finite.
std::vector<AxisTick> nice_ticks(double lo, double hi, int about = 5);

}  // namespace catena
