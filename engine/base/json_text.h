/// JSON text of a string, a number, a list, each on one line.
#pragma once
#include <cmath>
#include <string>

#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena {

inline std::string json_string(const std::string& text) {
  std::string out = "\"";
  for (const char c : one_line(text)) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

/// What is not a finite number is null.
inline std::string json_number(double value) { return std::isfinite(value) ? to_text(value) : "null"; }

template <class Items, class Print>
std::string json_list(const Items& items, const Print& print) {
  std::string text;
  for (const auto& item : items) text += (text.empty() ? "" : ", ") + print(item);
  return "[" + text + "]";
}

}  // namespace catena
