/// JSON with comments and positions: what the scene file and its parts are read from.
/// The library behind it (jsoncpp) stays inside json.cpp. Every reader names the file, the line, the key and what was expected.
#pragma once
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/result.h"
#include "engine/base/vec.h"

namespace catena::json {

/// What a JSON value is.
enum class Kind { null, boolean, number, string, array, object };

/// A value of a document with its place in the text. Plain data: copies are deep; reading is safe from any thread.
struct Node {
  Kind kind = Kind::null;                   ///< which of the members below mean something
  int line = 0;                             ///< 1-based line of the value; -1: it lies in no file, and `file` holds its place
  std::size_t begin = 0, end = 0;           ///< its bytes in the text, a byte order mark counted; its key and comments are outside
  std::shared_ptr<const std::string> file;  ///< the file's name as the user gave it
  std::string label;                        ///< its key, or "chain[2]" for an item; empty at the top level
  bool boolean = false;                     ///< the value of a boolean
  double number = 0;                        ///< the value of a number
  std::string string;                       ///< the value of a string
  std::vector<Node> items;                  ///< array
  std::vector<std::pair<std::string, Node>> members;  ///< object, in file order; keys are unique

  const Node* find(std::string_view key) const;  ///< nullptr if absent (or not an object)
  /// Whether the value is `null`.
  bool is_null() const { return kind == Kind::null; }
};

/// Parses a whole document. Comments are allowed; duplicate keys, trailing text and depth beyond 64 are errors.
Result<Node> parse(std::string_view text, const std::string& file);
/// Reads and parses a file. An error names the file, and the line where there is one.
Result<Node> read(const std::string& path);

/// The member, or the object that lacks it: where a message points.
const Node& member_or_parent(const Node& object, std::string_view key);

/// The same kinds, values, items and members in the same order, wherever they stand.
bool is_equal_value(const Node& a, const Node& b);

/// "scene.json:12: WHAT" at the node's place; without the line where it is 0, without the file where there is none.
Error error_at(const Node& node, const std::string& what);

/// An error for the first member whose key is not in `keys`, naming the nearest allowed ones.
Outcome check_known_keys(const Node& object, std::initializer_list<std::string_view> keys);
/// The same for keys that are known at run time only.
Outcome check_known_keys(const Node& object, const std::vector<std::string_view>& keys);
/// An error unless the node is an object; `what` stands for it in the message.
Outcome expect_object(const Node& node, std::string_view what);

/// TypedSlot readers of one member. `require_*` need the key; `get_*` give the fallback when it is absent.
/// All numbers must be finite. `what` in the messages is the key.
enum class NumberRange { any, positive, non_negative };
/// The number under `key`, which must be there.
Result<double> require_number(const Node& object, std::string_view key, NumberRange range = NumberRange::any);
/// The number under `key`, or `fallback` where there is none.
Result<double> get_number(const Node& object, std::string_view key, double fallback, NumberRange range = NumberRange::any);
/// The number under `key`, or nothing where there is none.
Result<std::optional<double>> get_optional_number(const Node& object, std::string_view key, NumberRange range = NumberRange::any);
/// The whole number under `key`, from `least` to `most`, or `fallback`.
Result<int> get_integer(const Node& object, std::string_view key, int fallback, int least, int most);
/// The boolean under `key`, or `fallback`.
Result<bool> get_boolean(const Node& object, std::string_view key, bool fallback);
/// The string under `key`, which must be there.
Result<std::string> require_string(const Node& object, std::string_view key);
/// The string under `key`, or `fallback`.
Result<std::string> get_string(const Node& object, std::string_view key, std::string fallback);
/// One word out of `words`; the index into it.
Result<int> get_choice(const Node& object, std::string_view key, int fallback, const std::vector<std::string_view>& words);
/// The three numbers under `key`, which must be there.
Result<Vec3> require_vec3(const Node& object, std::string_view key);
/// The three numbers under `key`, or `fallback`.
Result<Vec3> get_vec3(const Node& object, std::string_view key, const Vec3& fallback);
/// The three numbers under `key`, or nothing where there are none.
Result<std::optional<Vec3>> get_optional_vec3(const Node& object, std::string_view key);
/// A node itself as a number, a vector of three numbers, or rows of `width` numbers.
Result<double> as_number(const Node& node, std::string_view what, NumberRange range = NumberRange::any);
/// The node as three finite numbers.
Result<Vec3> as_vec3(const Node& node, std::string_view what);
/// The node as a string.
Result<std::string> as_string(const Node& node, std::string_view what);
/// A rotation: three rows of three numbers, nine numbers (row by row), or {"axis": [x, y, z], "angle_deg": a}; orthonormal to 1e-6.
Result<Mat3> as_rotation(const Node& node, std::string_view what);
/// The node as a list of lists of `width` finite numbers each.
Result<std::vector<std::vector<double>>> as_rows(const Node& node, std::string_view what, std::size_t width);

}  // namespace catena::json
