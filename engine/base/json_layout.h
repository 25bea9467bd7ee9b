/// The layout of JSON text about a container that json::parse has read: items put in and taken out with their commas, blanks and lines, as
/// json_edit.h says. The text must be the one that was parsed. Inside this room only.
#pragma once
#include <string>
#include <string_view>

#include "engine/base/json.h"

namespace catena::json {

/// A new last item of `container`, which is in `root`; `key` in quotes, or empty in an array.
std::string appended(std::string_view text, const Node& root, const Node& container, const std::string& key, const std::string& value);
/// A new item before the one that begins there.
std::string inserted(std::string_view text, std::size_t before, const std::string& value);
std::string without_item(std::string_view text, const Node& container, std::size_t index);

}  // namespace catena::json
