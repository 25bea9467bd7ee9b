/// Edits JSON text in place: one value changes, and comments, order, blanks and every other byte stay. Places are RFC 6901 pointers
/// ("/isosurfaces/0/level"; "~1" is a slash, "~0" a tilde in a key; "" the whole). What is put in follows the layout about it: a
/// container with its items on lines of their own gets one more line with their indentation, another stays on its line.
/// Every answer is JSON again, or the error says "FILE:LINE: what; what was expected" and nothing has changed.
#pragma once
#include <string>
#include <string_view>

#include "engine/base/json.h"

namespace catena::json {

/// Replaces the value, or adds it: a new member at the end of its object, an item at the end of its array ("-", or the first index that
/// is not there). Parents that lack are made: an array where the next step is "-" or "0", else an object. Of `value`, JSON text, the
/// comments around it are left away.
Result<std::string> set_value(std::string_view text, const std::string& file, std::string_view pointer, std::string_view value);
/// Puts a new item before the one of the array at that index.
Result<std::string> insert_item(std::string_view text, const std::string& file, std::string_view pointer, std::string_view value);
/// Takes out a member or an item with its comma. Comments about it stay, except those within it.
Result<std::string> remove_value(std::string_view text, const std::string& file, std::string_view pointer);

/// The value at the pointer; nullptr where there is none.
const Node* find_value(const Node& root, std::string_view pointer);

/// One step of a pointer: a key with "~" and "/" escaped.
std::string escape_pointer_token(std::string_view key);
/// `text` as a JSON string in quotes that reads back byte for byte.
std::string serialize_string(std::string_view text);
/// The node as JSON on one line, without its comments.
std::string serialize_node(const Node& node);
/// A finite number, the shortest text that reads back to the same double.
std::string serialize_number(double value);

/// The layout of JSON text about a container that json::parse has read: items put in and taken out with their commas, blanks and lines, as
/// json_edit.h says. The text must be the one that was parsed. Inside this room only.

/// A new last item of `container`, which is in `root`; `key` in quotes, or empty in an array.
std::string with_item_appended(std::string_view text, const Node& root, const Node& container, const std::string& key,
                               const std::string& value);
/// A new item before the one that begins there.
std::string with_item_inserted(std::string_view text, std::size_t before, const std::string& value);
std::string with_item_removed(std::string_view text, const Node& container, std::size_t index);

}  // namespace catena::json
