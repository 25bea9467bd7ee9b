// SPDX-License-Identifier: MIT
#include "engine/schema/values.h"

#include <charconv>
#include <cmath>

#include "engine/base/json_edit.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena::schema {

namespace {

bool is_absent(const Key& key, const json::Node& object) { return !key.is_required && object.find(key.name) == nullptr; }

/// Returns the Error "key KEY is missing; EXPECTED was expected" if a required key is absent.
Outcome check_present(const Key& key, const json::Node& object, const char* expected) {
  if (!key.is_required || object.find(key.name) != nullptr) return Done{};
  return json::error_at(object, "key " + in_quotes(key.name) + " is missing; " + expected + " was expected");
}

json::NumberRange range_of(const Key& key) {
  if (!key.limits.lo || *key.limits.lo != 0) return json::NumberRange::any;
  return key.limits.lo_open ? json::NumberRange::positive : json::NumberRange::non_negative;
}

std::string list_error(const Key& key, const std::string& items) {
  return in_quotes(key.name) + " is not a list or is empty; " + (key.range_text.empty() ? "" : key.range_text + " ") + items +
         " were expected";
}

template <class Items>
std::string list(const Items& items) {
  std::string out = "[";
  for (const auto& item : items) out += (out.size() > 1 ? ", " : "") + write_value(item);
  return out + "]";
}

/// Returns the Error "KEY is VALUE; a number from 0 to 1 was expected" if the number is outside the key's limits.
Outcome check_limits(const Key& key, const json::Node& node) {
  if (key.limits.contains(node.number)) return Done{};
  const std::string unit = key.unit.empty() || key.unit == "world" || key.unit == "value" ? "" : " " + key.unit;
  const Limits& l = key.limits;
  const std::string range = l.lo && l.hi ? "from " + to_text(*l.lo) + " to " + to_text(*l.hi) : l.to_string();
  return json::error_at(node, in_quotes(key.name) + " is " + to_text(node.number) + "; a number " + range + unit + " was expected");
}

}  // namespace

Outcome read_value(const Key& key, const json::Node& object, double& out) {
  if (is_absent(key, object)) return Done{};
  CATENA_TRY(out, json::require_number(object, key.name, range_of(key)));
  return check_limits(key, *object.find(key.name));
}

Outcome read_value(const Key& key, const json::Node& object, int& out) {
  CATENA_CHECK(check_present(key, object, "a whole number"));
  CATENA_TRY(out, json::get_integer(object, key.name, out, static_cast<int>(*key.limits.lo), static_cast<int>(*key.limits.hi)));
  return Done{};
}

Outcome read_value(const Key& key, const json::Node& object, bool& out) {
  if (key.value_type == ValueType::choice) {
    int index = out;
    CATENA_CHECK(read_choice(key, object, index));
    out = index == 1;
    return Done{};
  }
  CATENA_CHECK(check_present(key, object, "true or false"));
  CATENA_TRY(out, json::get_boolean(object, key.name, out));
  return Done{};
}

Outcome read_value(const Key& key, const json::Node& object, std::string& out) {
  if (is_absent(key, object)) return Done{};
  CATENA_TRY(out, json::require_string(object, key.name));
  return Done{};
}

Outcome read_value(const Key& key, const json::Node& object, Vec3& out) {
  if (is_absent(key, object)) return Done{};
  CATENA_TRY(out, json::require_vec3(object, key.name));
  if (key.range_text == "not 0" && max_abs(out) == 0)
    return json::error_at(*object.find(key.name), in_quotes(key.name) + " is zero; a vector other than [0, 0, 0] was expected");
  return Done{};
}

Outcome read_value(const Key& key, const json::Node& object, Mat3& out) {
  if (is_absent(key, object)) return Done{};
  CATENA_CHECK(check_present(key, object, "a rotation"));
  CATENA_TRY(out, json::as_rotation(*object.find(key.name), key.name));
  return Done{};
}

Outcome read_value(const Key& key, const json::Node& object, std::array<std::string, 3>& out) {
  if (is_absent(key, object)) return Done{};
  CATENA_CHECK(check_present(key, object, "a list of three names"));
  const json::Node& node = *object.find(key.name);
  if (node.kind != json::Kind::array || node.items.size() != 3)
    return json::error_at(node, in_quotes(key.name) + " is not a list of three names; names of the x, y and z axes were expected");
  for (std::size_t i = 0; i < 3; ++i) {
    CATENA_TRY(out[i], json::as_string(node.items[i], key.name));
  }
  return Done{};
}

Outcome read_value(const Key& key, const json::Node& object, std::vector<double>& out) {
  if (is_absent(key, object)) return Done{};
  CATENA_CHECK(check_present(key, object, "a list of numbers"));
  const json::Node& node = *object.find(key.name);
  if (node.kind != json::Kind::array || node.items.empty()) return json::error_at(node, list_error(key, "numbers [a, b, ...]"));
  out.clear();
  for (const json::Node& item : node.items) {
    CATENA_TRY(const double value, json::as_number(item, key.name));
    out.push_back(value);
  }
  return Done{};
}

Outcome read_value(const Key& key, const json::Node& object, std::array<double, 2>& out) {
  std::vector<double> values;
  CATENA_CHECK(read_value(key, object, values));
  if (values.empty()) return Done{};
  if (values.size() != 2) return json::error_at(*object.find(key.name), list_error(key, "two numbers [a, b]"));
  out = {values[0], values[1]};
  return Done{};
}

Outcome read_points(const json::Node& node, std::string_view what, std::vector<Vec3>& out) {
  if (node.kind != json::Kind::array || node.items.empty())
    return json::error_at(node, in_quotes(what) + " is not a list of positions or is empty; at least one [x, y, z] was expected");
  out.clear();
  out.reserve(node.items.size());
  for (const json::Node& item : node.items) {
    CATENA_TRY(const Vec3 p, json::as_vec3(item, what));
    out.push_back(p);
  }
  return Done{};
}

Outcome read_value(const Key& key, const json::Node& object, std::vector<Vec3>& out) {
  if (is_absent(key, object)) return Done{};
  CATENA_CHECK(check_present(key, object, "a list of positions [x, y, z]"));
  return read_points(*object.find(key.name), key.name, out);
}

Result<Color> as_color(const Vec3& c, const json::Node& node, std::string_view what) {
  for (int i = 0; i < 3; ++i)
    if (!(c[i] >= 0 && c[i] <= 1))
      return json::error_at(node, in_quotes(what) + " holds " + to_text(c[i]) + "; colour components from 0 to 1 were expected");
  return Color{static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)};
}

Outcome read_value(const Key& key, const json::Node& object, Color& out) {
  if (is_absent(key, object)) return Done{};
  CATENA_TRY(const Vec3 components, json::require_vec3(object, key.name));
  CATENA_TRY(out, as_color(components, *object.find(key.name), key.name));
  return Done{};
}

Outcome read_choice(const Key& key, const json::Node& object, int& out) {
  if (key.is_required) CATENA_CHECK(json::require_string(object, key.name));
  CATENA_TRY(out, json::get_choice(object, key.name, out, option_names(key)));
  return Done{};
}

std::string write_value(const Color& c) {
  std::string out = "[";
  for (const float component : {c.r, c.g, c.b}) {
    CATENA_ASSERT(std::isfinite(component));
    char digits[40];
    out += (out.size() > 1 ? ", " : "") + std::string(digits, std::to_chars(digits, digits + sizeof digits, component).ptr);
  }
  return out + "]";
}
std::string write_value(double value) { return json::serialize_number(value); }
std::string write_value(int value) { return std::to_string(value); }
std::string write_value(bool value) { return value ? "true" : "false"; }
std::string write_value(const std::string& value) { return json::serialize_string(value); }
std::string write_value(const Vec3& v) { return list(std::array<double, 3>{v.x, v.y, v.z}); }
std::string write_value(const std::array<double, 2>& value) { return list(value); }
std::string write_value(const std::array<std::string, 3>& value) { return list(value); }
std::string write_value(const std::vector<double>& value) { return list(value); }
std::string write_value(const std::vector<std::string>& value) { return list(value); }
std::string write_value(const std::vector<Vec3>& value) { return list(value); }
/// Writes the rows; the matrix is stored by columns.
std::string write_value(const Mat3& m) {
  std::vector<Vec3> rows;
  for (int i = 0; i < 3; ++i) rows.emplace_back(m[0][i], m[1][i], m[2][i]);
  return list(rows);
}

}  // namespace catena::schema
