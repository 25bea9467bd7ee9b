// SPDX-License-Identifier: MIT
#include "engine/base/json.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena::json {
namespace {

/// Returns a description of the node's value for messages "... but X was found".
std::string describe_value(const Node& node) {
  switch (node.kind) {
    case Kind::null:
      return "null";
    case Kind::boolean:
      return node.boolean ? "true" : "false";
    case Kind::number:
      return to_text(node.number);
    case Kind::string:
      return in_quotes(node.string);
    case Kind::array:
      return "an array of " + std::to_string(node.items.size());
    case Kind::object:
      return "an object";
  }
  return "null";
}

const char* range_words(NumberRange range) {
  switch (range) {
    case NumberRange::any:
      return "a finite number";
    case NumberRange::positive:
      return "a finite number > 0";
    case NumberRange::non_negative:
      return "a finite number >= 0";
  }
  return "a finite number";
}

Error unlike(const Node& node, std::string_view what, const std::string& expected) {
  return error_at(node, in_quotes(what) + " is " + describe_value(node) + "; " + expected + " was expected");
}

std::string place_words(const Node& object) { return object.label.empty() ? "at the top level" : "in " + in_quotes(object.label); }

Error missing(const Node& object, std::string_view key, const std::string& expected) {
  return error_at(object, "key " + in_quotes(key) + " is missing " + place_words(object) + "; " + expected + " was expected");
}

}  // namespace

Outcome check_known_keys(const Node& object, const std::vector<std::string_view>& keys) {
  for (const auto& [name, value] : object.members) {
    bool known = false;
    for (std::string_view key : keys) known = known || key == name;
    if (known) continue;
    return error_at(value,
                    "unknown key " + in_quotes(name) + " " + place_words(object) + "; known: " + join_words(keys) + suggestion(name, keys));
  }
  return Done{};
}

Outcome check_known_keys(const Node& object, std::initializer_list<std::string_view> keys) {
  return check_known_keys(object, std::vector<std::string_view>(keys));
}

Outcome expect_object(const Node& node, std::string_view what) {
  if (node.kind == Kind::object) return Done{};
  return unlike(node, what, "an object {...}");
}

// ---- numbers ----

Result<double> as_number(const Node& node, std::string_view what, NumberRange range) {
  const bool valid = node.kind == Kind::number && std::isfinite(node.number) && !(range == NumberRange::positive && node.number <= 0) &&
                     !(range == NumberRange::non_negative && node.number < 0);
  if (!valid) return unlike(node, what, range_words(range));
  return node.number;
}

Result<double> require_number(const Node& object, std::string_view key, NumberRange range) {
  if (const Node* node = object.find(key)) return as_number(*node, key, range);
  return missing(object, key, range_words(range));
}

Result<double> get_number(const Node& object, std::string_view key, double fallback, NumberRange range) {
  if (const Node* node = object.find(key)) return as_number(*node, key, range);
  return fallback;
}

Result<std::optional<double>> get_optional_number(const Node& object, std::string_view key, NumberRange range) {
  const Node* node = object.find(key);
  if (node == nullptr) return std::optional<double>();
  CATENA_TRY(const double value, as_number(*node, key, range));
  return std::optional<double>(value);
}

Result<int> get_integer(const Node& object, std::string_view key, int fallback, int minimum, int maximum) {
  const Node* node = object.find(key);
  if (node == nullptr) return fallback;
  if (node->kind != Kind::number || std::floor(node->number) != node->number || node->number < minimum || node->number > maximum)
    return unlike(*node, key, "a whole number from " + std::to_string(minimum) + " to " + std::to_string(maximum));
  return static_cast<int>(node->number);
}

// ---- booleans and strings ----

Result<bool> get_boolean(const Node& object, std::string_view key, bool fallback) {
  const Node* node = object.find(key);
  if (node == nullptr) return fallback;
  if (node->kind != Kind::boolean) return unlike(*node, key, "true or false");
  return node->boolean;
}

Result<std::string> as_string(const Node& node, std::string_view what) {
  if (node.kind != Kind::string) return unlike(node, what, "a string");
  if (node.string.find('\0') != std::string::npos) return unlike(node, what, "a string without zero bytes");
  return node.string;
}

Result<std::string> require_string(const Node& object, std::string_view key) {
  const Node* node = object.find(key);
  if (node == nullptr) return missing(object, key, "a string");
  return as_string(*node, key);
}

Result<std::string> get_string(const Node& object, std::string_view key, std::string fallback) {
  return object.find(key) == nullptr ? Result<std::string>(std::move(fallback)) : require_string(object, key);
}

Result<int> get_choice(const Node& object, std::string_view key, int fallback, const std::vector<std::string_view>& words) {
  const Node* node = object.find(key);
  if (node == nullptr) return fallback;
  if (node->kind == Kind::string)
    for (std::size_t i = 0; i < words.size(); ++i)
      if (node->string == words[i]) return static_cast<int>(i);
  return unlike(*node, key, "one of " + join_words(words));
}

// ---- vectors and tables ----

Result<Vec3> as_vec3(const Node& node, std::string_view what) {
  const std::string expected = "three finite numbers [x, y, z]";
  if (node.kind != Kind::array || node.items.size() != 3) return unlike(node, what, expected);
  Vec3 v(0.0);
  for (int i = 0; i < 3; ++i) {
    const Node& item = node.items[static_cast<std::size_t>(i)];
    if (item.kind != Kind::number || !std::isfinite(item.number))
      return error_at(item, in_quotes(what) + " holds " + describe_value(item) + "; " + expected + " were expected");
    v[i] = item.number;
  }
  return v;
}

Result<Vec3> require_vec3(const Node& object, std::string_view key) {
  if (const Node* node = object.find(key)) return as_vec3(*node, key);
  return missing(object, key, "three finite numbers [x, y, z]");
}

Result<Vec3> get_vec3(const Node& object, std::string_view key, const Vec3& fallback) {
  if (const Node* node = object.find(key)) return as_vec3(*node, key);
  return fallback;
}

Result<std::optional<Vec3>> get_optional_vec3(const Node& object, std::string_view key) {
  const Node* node = object.find(key);
  if (node == nullptr) return std::optional<Vec3>();
  CATENA_TRY(const Vec3 value, as_vec3(*node, key));
  return std::optional<Vec3>(value);
}

Result<std::vector<std::vector<double>>> as_rows(const Node& node, std::string_view what, std::size_t width) {
  const std::string expected = "rows of " + std::to_string(width) + " finite numbers";
  if (node.kind != Kind::array) return unlike(node, what, "an array of " + expected);
  std::vector<std::vector<double>> rows;
  for (const Node& row : node.items) {
    if (row.kind != Kind::array || row.items.size() != width)
      return error_at(row, in_quotes(what) + " holds " + describe_value(row) + "; " + expected + " were expected");
    auto& out = rows.emplace_back();
    for (const Node& item : row.items) {
      if (item.kind != Kind::number || !std::isfinite(item.number))
        return error_at(item, in_quotes(what) + " holds " + describe_value(item) + "; " + expected + " were expected");
      out.push_back(item.number);
    }
  }
  return rows;
}

Result<Mat3> as_rotation(const Node& node, std::string_view what) {
  const std::string expected = "three orthonormal rows of three numbers, or {\"axis\": [x, y, z], \"angle_deg\": a}, were expected";
  if (node.kind == Kind::object) {
    CATENA_CHECK(check_known_keys(node, {"axis", "angle_deg"}));
    CATENA_TRY(const Vec3 axis, require_vec3(node, "axis"));
    if (norm(axis) == 0) return error_at(*node.find("axis"), "\"axis\" is zero; a vector other than [0, 0, 0] was expected");
    CATENA_TRY(const double angle_deg, require_number(node, "angle_deg"));
    // Rodrigues' formula: R e = e cos a + (u x e) sin a + u (u . e)(1 - cos a)
    const Vec3 u = direction(axis);
    const double angle = angle_deg * (3.14159265358979323846 / 180.0), c = std::cos(angle), s = std::sin(angle);
    Mat3 rotation(1.0);
    for (int i = 0; i < 3; ++i) {
      Vec3 e(0.0);
      e[i] = 1;
      rotation[i] = e * c + cross(u, e) * s + u * (u[i] * (1 - c));
    }
    return rotation;
  }
  const bool flat = node.kind == Kind::array && node.items.size() == 9;
  if (node.kind != Kind::array || (!flat && node.items.size() != 3))
    return error_at(node, in_quotes(what) + " has the wrong shape; " + expected);
  Mat3 rotation(1.0);
  for (int row = 0; row < 3; ++row) {
    Vec3 values(0.0);
    if (flat) {
      for (int i = 0; i < 3; ++i) {
        CATENA_TRY(values[i], as_number(node.items[static_cast<std::size_t>(3 * row + i)], what));
      }
    } else {
      CATENA_TRY(values, as_vec3(node.items[static_cast<std::size_t>(row)], what));
    }
    for (int column = 0; column < 3; ++column) rotation[column][row] = values[column];
  }
  double max_deviation = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) max_deviation = std::max(max_deviation, std::fabs(dot(rotation[i], rotation[j]) - (i == j ? 1.0 : 0.0)));
  if (!(max_deviation <= 1e-6) || dot(cross(rotation[0], rotation[1]), rotation[2]) < 0)
    return error_at(node, in_quotes(what) + " is no rotation; " + expected);
  return rotation;
}

}  // namespace catena::json
