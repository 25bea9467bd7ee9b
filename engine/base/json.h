// SPDX-License-Identifier: MIT
/// Reader for JSON with comments that retains positions in the text; the scene file and its sections are read with it. The library behind
/// it (jsoncpp) is private to json.cpp. Every error names the file, the line, the key and what was expected.
#pragma once
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/export.h"
#include "engine/base/result.h"
#include "engine/base/vec.h"

namespace catena::json {

/// Kind of a JSON value.
enum class Kind { null, boolean, number, string, array, object };

/// A value of a document with its location in the text. Plain data: a copy is deep; reading is safe from any thread.
struct CATENA_EXPORT Node {
  Kind kind = Kind::null;  ///< selects which of the members below are meaningful
  int line = 0;            ///< 1-based line of the value; -1: the value comes from no file, and `file` is its location as text
  std::size_t begin = 0;   ///< first byte of the value, counted in the text with its byte order mark; key and comments are outside
  std::size_t end = 0;     ///< byte after the value
  std::shared_ptr<const std::string> file;            ///< file name as given by the user
  std::string label;                                  ///< key of the value, or "chain[2]" for an item of an array; empty at the top level
  bool boolean = false;                               ///< value of a boolean
  double number = 0;                                  ///< value of a number
  std::string string;                                 ///< value of a string
  std::vector<Node> items;                            ///< items of an array
  std::vector<std::pair<std::string, Node>> members;  ///< members of an object, in file order; keys are unique

  /// Returns the member with a key; nullptr when it is absent or this is not an object.
  const Node* find(std::string_view key) const;
  /// Returns true when the value is `null`.
  bool is_null() const { return kind == Kind::null; }
};

/// Parses a whole document; `file` is the name for messages. Comments are allowed. Errors: invalid JSON, duplicate keys, trailing text,
/// nesting deeper than 64 levels, a number that is not finite, a text larger than the memory budget.
CATENA_EXPORT Result<Node> parse(std::string_view text, const std::string& file);
/// Reads and parses a file. An Error names the file, and the line where there is one. The file may have at most kMaxJsonBytes.
CATENA_EXPORT Result<Node> read(const std::string& path);

/// Returns the member with a key, or `object` itself when it has no such member: the location at which a message points.
CATENA_EXPORT const Node& member_or_parent(const Node& object, std::string_view key);

/// Returns true when two nodes have the same kind and value, and the same items and members in the same order; locations are ignored.
CATENA_EXPORT bool is_equal_value(const Node& a, const Node& b);

/// Makes an Error with the location of the node: "scene.json:12: WHAT"; without the line when it is 0 or -1, without the file when there is
/// none.
CATENA_EXPORT Error error_at(const Node& node, const std::string& what);

/// Error for the first member whose key is not in `keys`; the message lists the known keys and suggests a similar one.
CATENA_EXPORT Outcome check_known_keys(const Node& object, std::initializer_list<std::string_view> keys);
/// Error for the first member whose key is not in `keys`, a list that is made at run time; the message is the same.
CATENA_EXPORT Outcome check_known_keys(const Node& object, const std::vector<std::string_view>& keys);
/// Error unless the node is an object; `what` names it in the message.
CATENA_EXPORT Outcome expect_object(const Node& node, std::string_view what);

/// Range of allowed numbers: any finite number, > 0, or >= 0.
enum class NumberRange { any, positive, non_negative };

/// Typed readers of one member of an object. `require_*` return an Error when the key is absent; `get_*` return the fallback, or nullopt,
/// then. All of them return an Error when the value has another type or is out of range. All numbers must be finite. The messages name the
/// key.

/// Returns the number at `key`; an Error when it is absent.
CATENA_EXPORT Result<double> require_number(const Node& object, std::string_view key, NumberRange range = NumberRange::any);
/// Returns the number at `key`, or `fallback` when it is absent.
CATENA_EXPORT Result<double> get_number(const Node& object, std::string_view key, double fallback, NumberRange range = NumberRange::any);
/// Returns the number at `key`, or nullopt when it is absent.
CATENA_EXPORT Result<std::optional<double>> get_optional_number(const Node& object, std::string_view key,
                                                                NumberRange range = NumberRange::any);
/// Returns the integer at `key`, which must be in `minimum`..`maximum`, or `fallback` when it is absent.
CATENA_EXPORT Result<int> get_integer(const Node& object, std::string_view key, int fallback, int minimum, int maximum);
/// Returns the boolean at `key`, or `fallback` when it is absent.
CATENA_EXPORT Result<bool> get_boolean(const Node& object, std::string_view key, bool fallback);
/// Returns the string at `key`; an Error when it is absent.
CATENA_EXPORT Result<std::string> require_string(const Node& object, std::string_view key);
/// Returns the string at `key`, or `fallback` when it is absent.
CATENA_EXPORT Result<std::string> get_string(const Node& object, std::string_view key, std::string fallback);
/// Returns the index in `words` of the string at `key`, or `fallback` when it is absent. Error: the string is none of `words`.
CATENA_EXPORT Result<int> get_choice(const Node& object, std::string_view key, int fallback, const std::vector<std::string_view>& words);
/// Returns the three numbers at `key`; an Error when they are absent.
CATENA_EXPORT Result<Vec3> require_vec3(const Node& object, std::string_view key);
/// Returns the three numbers at `key`, or `fallback` when they are absent.
CATENA_EXPORT Result<Vec3> get_vec3(const Node& object, std::string_view key, const Vec3& fallback);
/// Returns the three numbers at `key`, or nullopt when they are absent.
CATENA_EXPORT Result<std::optional<Vec3>> get_optional_vec3(const Node& object, std::string_view key);
/// Converts the node itself to a finite number in `range`; `what` names it in the message.
CATENA_EXPORT Result<double> as_number(const Node& node, std::string_view what, NumberRange range = NumberRange::any);
/// Converts the node to three finite numbers.
CATENA_EXPORT Result<Vec3> as_vec3(const Node& node, std::string_view what);
/// Converts the node to a string without zero bytes.
CATENA_EXPORT Result<std::string> as_string(const Node& node, std::string_view what);
/// Converts the node to a rotation matrix. Accepted forms: three rows of three numbers, nine numbers (row by row), or {"axis": [x, y, z],
/// "angle_deg": a}. The rows must be orthonormal to 1e-6 and right-handed, the axis must not be zero.
CATENA_EXPORT Result<Mat3> as_rotation(const Node& node, std::string_view what);
/// Converts the node to a list of rows of `width` finite numbers each.
CATENA_EXPORT Result<std::vector<std::vector<double>>> as_rows(const Node& node, std::string_view what, std::size_t width);

}  // namespace catena::json
