// SPDX-License-Identifier: MIT
/// Numbers as text for the sentences of a report. Any thread.
#pragma once
#include <fmt/format.h>

#include <string>

namespace catena::app::tuning {

/// Returns the text with a short exponent, "1.2e-6" for "1.2e-06", as in scene keys.
inline std::string with_short_exponent(std::string text) {
  const auto at = text.find("e-0");
  if (at != std::string::npos) text.erase(at + 2, 1);
  return text;
}
/// Returns the number with two significant digits, or as many as given.
inline std::string format_number(double value, int digits = 2) { return with_short_exponent(fmt::format("{:.{}g}", value, digits)); }

}  // namespace catena::app::tuning
