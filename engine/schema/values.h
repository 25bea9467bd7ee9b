/// A key's value as C++ sees it: read_value checks it by the key's own range and words, write_value makes the JSON text that reads back the
/// same. One pair a type. A key that is absent leaves the value as it is, unless it is required.
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
Outcome read_value(const Key& key, const json::Node& object, bool& out);  ///< or the first (false) and the second of two words
Outcome read_value(const Key& key, const json::Node& object, std::string& out);
Outcome read_value(const Key& key, const json::Node& object, Vec3& out);
Outcome read_value(const Key& key, const json::Node& object, Mat3& out);
Outcome read_value(const Key& key, const json::Node& object, std::array<std::string, 3>& out);
Outcome read_value(const Key& key, const json::Node& object, std::vector<double>& out);
Outcome read_value(const Key& key, const json::Node& object, std::vector<Vec3>& out);
Outcome read_value(const Key& key, const json::Node& object, Color& out);
/// A list of [x, y, z], at least one.
Outcome read_points(const json::Node& node, std::string_view what, std::vector<Vec3>& out);
/// The index of a word.
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
std::string write_value(const Color& value);  ///< components, which are floats, in the fewest digits that give the same float

/// Three numbers from 0 to 1 as a colour.
Result<Color> as_color(const Vec3& components, const json::Node& node, std::string_view what);

/// An enum: its words in their order.
template <class E>
requires std::is_enum_v<E> Outcome read_value(const Key& key, const json::Node& object, E& out) {
  int index = static_cast<int>(out);
  CATENA_CHECK(read_choice(key, object, index));
  out = static_cast<E>(index);
  return Done{};
}

template <class T>
Outcome read_value(const Key& key, const json::Node& object, std::optional<T>& out) {
  if (object.find(key.name) == nullptr && !key.is_required) return Done{};
  T value{};
  CATENA_CHECK(read_value(key, object, value));
  out = std::move(value);
  return Done{};
}

}  // namespace catena::schema
