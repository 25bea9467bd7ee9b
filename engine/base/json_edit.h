// SPDX-License-Identifier: MIT
/// Editing of JSON text in place: one value changes; comments, order, blanks and every other byte stay. A location is an RFC 6901 JSON
/// pointer ("/isosurfaces/0/level"; in a key, "~1" stands for a slash and "~0" for a tilde; "" is the whole document). Inserted text
/// follows the surrounding layout: a container with its items on separate lines gets another line with the same indentation, any other
/// container stays on its line. Every result is valid JSON; otherwise an Error "FILE:LINE: what; what was expected" is returned and nothing
/// has changed.
#pragma once
#include <string>
#include <string_view>

#include "engine/base/json.h"

namespace catena::json {

/// Replaces the value at the pointer, or adds it: a new member at the end of its object, an item at the end of its array (index "-" or the
/// array's size). Missing parents are created: an array when the next step is "-" or "0", else an object. `value` is JSON text; comments
/// around it are dropped.
Result<std::string> set_value(std::string_view text, const std::string& file, std::string_view pointer, std::string_view value);
/// Inserts a new item before the array item at the pointer; appends it when the index is the array's size or "-".
Result<std::string> insert_item(std::string_view text, const std::string& file, std::string_view pointer, std::string_view value);
/// Removes a member or an item with its comma. Comments around it stay; comments inside it are removed.
Result<std::string> remove_value(std::string_view text, const std::string& file, std::string_view pointer);

/// Range of bytes in a text, and the text to put there.
struct Replacement {
  std::size_t begin, end;
  std::string text;
};
/// Makes the replacement of the key of member number `index` of `container`, a node that json::parse made from `text`.
Replacement rename_key(std::string_view text, const Node& container, std::size_t index, std::string_view key);
/// Replaces ranges that do not overlap, in any order.
Result<std::string> replace_ranges(std::string_view text, const std::string& file, std::vector<Replacement> edits);

/// Returns the value at the pointer; nullptr when there is none.
const Node* find_value(const Node& root, std::string_view pointer);

/// Escapes a key as one step of a pointer: "~" and "/" become "~0" and "~1".
std::string escape_pointer_token(std::string_view key);
/// Returns `text` as a quoted JSON string that reads back byte for byte.
std::string serialize_string(std::string_view text);
/// Returns the node as JSON on one line, without its comments.
std::string serialize_node(const Node& node);
/// Returns a finite number as the shortest text that reads back to the same double.
std::string serialize_number(double value);

/// Layout of JSON text around a container: items are inserted and removed with their commas, blanks and lines, as described at the top of
/// this file. `text` must be the text from which json::parse made the nodes. Private to this module.

/// Appends an item to `container`, a node inside `root`; `key` is a quoted key, or empty for an array.
std::string with_item_appended(std::string_view text, const Node& root, const Node& container, const std::string& key,
                               const std::string& value);
/// Inserts an item before the item that begins at byte `before`.
std::string with_item_inserted(std::string_view text, std::size_t before, const std::string& value);
/// Removes the item or member number `index` of `container`.
std::string with_item_removed(std::string_view text, const Node& container, std::size_t index);

}  // namespace catena::json
