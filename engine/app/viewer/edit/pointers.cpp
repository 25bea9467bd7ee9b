#include "engine/app/viewer/edit/pointers.h"

#include <algorithm>

#include "engine/scene/write_values.h"

namespace catena::app {

std::string pointer_of(const json::Node& item) {
  const std::size_t open = item.label.find('[');
  if (item.line <= 0 || open == std::string::npos || open == 0 || !item.label.ends_with(']')) return {};
  const std::string index = item.label.substr(open + 1, item.label.size() - open - 2);
  if (index.empty() || !std::all_of(index.begin(), index.end(), [](char c) { return c >= '0' && c <= '9'; })) return {};
  return "/" + item.label.substr(0, open) + "/" + index;
}

std::string node_text(const json::Node& node) {
  std::string text;
  const auto next = [&] { text += text.size() > 1 ? ", " : ""; };
  switch (node.kind) {
    case json::Kind::null:
      return "null";
    case json::Kind::boolean:
      return node.boolean ? "true" : "false";
    case json::Kind::number:
      return scene::text_of(node.number);
    case json::Kind::string:
      return scene::text_of(node.string);
    case json::Kind::array:
      text = "[";
      for (const json::Node& item : node.items) next(), text += node_text(item);
      return text + "]";
    case json::Kind::object:
      text = "{";
      for (const auto& [key, member] : node.members) next(), text += scene::text_of(key) + ": " + node_text(member);
      return text + "}";
  }
  return text;
}

}  // namespace catena::app
