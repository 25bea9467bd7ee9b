/// Numbers as text: printed so that they read back exactly, read strictly (the whole word, decimal point, no locale).
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace catena {

/// The shortest text that reads back to the same double; "nan", "inf", "-inf" for those.
std::string to_text(double value);
void append_text(std::string& out, double value);

/// A finite or non-finite double; nothing if `text` (blanks at its ends allowed) is not wholly a number.
std::optional<double> parse_double(std::string_view text);
std::optional<long long> parse_integer(std::string_view text);

std::string_view trim(std::string_view text);

}  // namespace catena
