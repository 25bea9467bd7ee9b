/// Text as a JSON string, quoted, on one line.
#pragma once
#include <string>

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

}  // namespace catena
