// SPDX-License-Identifier: MIT
/// One-line JSON for `catena info --json`: strings are sanitized for a terminal, numbers that are not finite become null.
#pragma once
#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/bounds.h"
#include "engine/base/json_text.h"
#include "engine/base/text.h"

namespace catena::app {

inline std::string to_json_value(const std::string& text) { return json_string(sanitize_for_terminal(text)); }
inline std::string to_json_value(const char* text) { return to_json_value(std::string(text)); }
inline std::string to_json_value(bool value) { return value ? "true" : "false"; }
inline std::string to_json_value(double value) { return json_number(value); }
inline std::string to_json_value(std::int64_t value) { return std::to_string(value); }
inline std::string to_json_value(std::uint64_t value) { return std::to_string(value); }
inline std::string to_json_value(const std::optional<double>& value) { return value ? to_json_value(*value) : "null"; }
inline std::string to_json_value(const Vec3& v) {
  return fmt::format("[{},{},{}]", to_json_value(v.x), to_json_value(v.y), to_json_value(v.z));
}
inline std::string to_json_value(const Bounds& box) { return fmt::format("[{},{}]", to_json_value(box.lo), to_json_value(box.hi)); }

/// Makes an array of values that are JSON text.
inline std::string json_array(const std::vector<std::string>& items) {
  std::string out = "[";
  for (const std::string& item : items) out += (out.size() > 1 ? "," : "") + item;
  return out + "]";
}

/// Builds a JSON object, member by member.
class JsonObject {
 public:
  template <class T>
  JsonObject& add(const std::string& key, const T& value) {
    return add_raw(key, to_json_value(value));
  }
  /// Adds a member whose value is JSON text.
  JsonObject& add_raw(const std::string& key, const std::string& json) {
    text_ += (text_.size() > 1 ? "," : "") + json_string(key) + ":" + json;
    return *this;
  }
  /// Adds a string member, unless it is empty.
  JsonObject& add_if_not_empty(const std::string& key, const std::string& word) { return word.empty() ? *this : add(key, word); }
  std::string text() const { return text_ + "}"; }

 private:
  std::string text_ = "{";
};

}  // namespace catena::app
