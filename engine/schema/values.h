// SPDX-License-Identifier: MIT
/// Conversion between JSON and C++ values of a key: read_value checks a value against the range and options of its key, write_value returns
/// JSON text that reads back to the same value. One pair of functions per type.
/// An absent key leaves `out` unchanged. An absent required key is an Error for double, text, Vec3, Color and choices; int and bool do not
/// check it; for rotations and lists (Mat3, array, vector) the caller must make sure that a required key is present.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/base/color.h"
#include "engine/base/json.h"
#include "engine/schema/key.h"

namespace catena::schema {

Outcome read_value(const Key& key, const json::Node& object, double& out);
Outcome read_value(const Key& key, const json::Node& object, int& out);
/// Reads a boolean; for a choice, the first of two options is false and the second true.
Outcome read_value(const Key& key, const json::Node& object, bool& out);
Outcome read_value(const Key& key, const json::Node& object, std::string& out);
Outcome read_value(const Key& key, const json::Node& object, Vec3& out);
Outcome read_value(const Key& key, const json::Node& object, Mat3& out);
Outcome read_value(const Key& key, const json::Node& object, std::array<std::string, 3>& out);
Outcome read_value(const Key& key, const json::Node& object, std::vector<double>& out);
Outcome read_value(const Key& key, const json::Node& object, std::array<double, 2>& out);
Outcome read_value(const Key& key, const json::Node& object, std::vector<Vec3>& out);
Outcome read_value(const Key& key, const json::Node& object, Color& out);
/// Reads a list of at least one [x, y, z].
Outcome read_points(const json::Node& node, std::string_view what, std::vector<Vec3>& out);
/// Reads the index of an option of a choice.
Outcome read_choice(const Key& key, const json::Node& object, int& out);

std::string write_value(double value);
std::string write_value(int value);
std::string write_value(bool value);
std::string write_value(const std::string& value);
std::string write_value(const Vec3& value);
std::string write_value(const Mat3& value);
std::string write_value(const std::array<double, 2>& value);
std::string write_value(const std::array<std::string, 3>& value);
std::string write_value(const std::vector<double>& value);
std::string write_value(const std::vector<std::string>& value);
std::string write_value(const std::vector<Vec3>& value);
/// Writes the components, which are floats, with the fewest digits that give the same float.
std::string write_value(const Color& value);

/// Converts three numbers from 0 to 1 to a color.
Result<Color> as_color(const Vec3& components, const json::Node& node, std::string_view what);

/// Reads an enum: the index of the option is the value of the enumerator.
template <class E>
requires std::is_enum_v<E> Outcome read_value(const Key& key, const json::Node& object, E& out) {
  int index = static_cast<int>(out);
  CATENA_CHECK(read_choice(key, object, index));
  out = static_cast<E>(index);
  return Done{};
}

/// Reads an optional value; an absent key leaves it unchanged.
template <class T>
Outcome read_value(const Key& key, const json::Node& object, std::optional<T>& out) {
  if (object.find(key.name) == nullptr && !key.is_required) return Done{};
  T value{};
  CATENA_CHECK(read_value(key, object, value));
  out = std::move(value);
  return Done{};
}

}  // namespace catena::schema
