/// NumberArray as a report's sentences have them. Any thread.
#pragma once
#include <fmt/format.h>

#include <string>

namespace catena::app::tradeoff {

/// "1.2e-6" of "1.2e-06": as a person writes it, and as keys have it.
inline std::string with_short_exponent(std::string text) {
  const auto at = text.find("e-0");
  if (at != std::string::npos) text.erase(at + 2, 1);
  return text;
}
/// To two digits, or as many as are said.
inline std::string format_number(double value, int digits = 2) { return with_short_exponent(fmt::format("{:.{}g}", value, digits)); }

}  // namespace catena::app::tradeoff
