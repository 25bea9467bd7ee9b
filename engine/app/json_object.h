/// JSON on one line as `catena info --json` prints it: texts as a terminal may show them, what is not a finite number as null.
#pragma once
#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/json_text.h"
#include "engine/base/text.h"
#include "engine/geometry/bounds.h"

namespace catena::app {

inline std::string json_of(const std::string& text) { return json_string(printable(text)); }
inline std::string json_of(const char* text) { return json_of(std::string(text)); }
inline std::string json_of(bool value) { return value ? "true" : "false"; }
inline std::string json_of(double value) { return json_number(value); }
inline std::string json_of(std::int64_t value) { return std::to_string(value); }
inline std::string json_of(std::uint64_t value) { return std::to_string(value); }
inline std::string json_of(const std::optional<double>& value) { return value ? json_of(*value) : "null"; }
inline std::string json_of(const Vec3& v) { return fmt::format("[{},{},{}]", json_of(v.x), json_of(v.y), json_of(v.z)); }
inline std::string json_of(const Bounds& box) { return fmt::format("[{},{}]", json_of(box.lo), json_of(box.hi)); }

/// Of values that are JSON already.
inline std::string json_array(const std::vector<std::string>& items) {
  std::string out = "[";
  for (const std::string& item : items) out += (out.size() > 1 ? "," : "") + item;
  return out + "]";
}

/// An object, member by member.
class JsonObject {
 public:
  template <class T>
  JsonObject& add(const std::string& key, const T& value) {
    return raw(key, json_of(value));
  }
  JsonObject& raw(const std::string& key, const std::string& json) {
    text_ += (text_.size() > 1 ? "," : "") + json_string(key) + ":" + json;
    return *this;
  }
  /// Nothing where the text is empty.
  JsonObject& add_word(const std::string& key, const std::string& word) { return word.empty() ? *this : add(key, word); }
  std::string text() const { return text_ + "}"; }

 private:
  std::string text_ = "{";
};

}  // namespace catena::app
