// SPDX-License-Identifier: MIT
/// JSON text of a string, a number or a list, each on one line.
#pragma once
#include <cmath>
#include <string>

#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena {

/// Returns `text` as a quoted JSON string; control characters become blanks.
inline std::string json_string(const std::string& text) {
  std::string out = "\"";
  for (const char c : one_line(text)) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

/// Returns a number as JSON text; "null" for a number that is not finite.
inline std::string json_number(double value) { return std::isfinite(value) ? to_text(value) : "null"; }

/// Returns a JSON array of `print(item)` for each item.
template <class Items, class Print>
std::string json_list(const Items& items, const Print& print) {
  std::string text;
  for (const auto& item : items) text += (text.empty() ? "" : ", ") + print(item);
  return "[" + text + "]";
}

}  // namespace catena
