#include "engine/app/viewer/edit/edit_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/assert.h"
#include "engine/base/json_text.h"
#include "engine/base/numbers.h"

namespace catena::app {

namespace {

/// The shortest that reads back to the same float.
std::string of_float(float value) { return fmt::format("{}", value == 0 ? 0.0f : value); }

/// Row by row, "[a, b]" each.
template <class Items, class Write>
std::string list_of(const Items& items, Write&& write) {
  std::string text = "[";
  for (const auto& item : items) text += (text.size() > 1 ? ", " : "") + write(item);
  return text + "]";
}

/// JSON's own escapes; the rest of the text as it is.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      (out += '\\') += c;
    else if (static_cast<unsigned char>(c) < 0x20)
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    else
      out += c;
  }
  return out + "\"";
}

}  // namespace

std::string pointer_of(const json::Node& item) {
  const std::size_t open = item.label.find('[');
  if (item.line <= 0 || open == std::string::npos || open == 0 || !item.label.ends_with(']')) return {};
  const std::string index = item.label.substr(open + 1, item.label.size() - open - 2);
  if (index.empty() || !std::all_of(index.begin(), index.end(), [](char c) { return c >= '0' && c <= '9'; })) return {};
  return "/" + item.label.substr(0, open) + "/" + index;
}

std::string pointer_to(std::string_view parent, std::string_view key) {
  std::string out(parent);
  out += '/';
  for (const char c : key) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return out;
}

std::string json_of(double value) {
  CATENA_ASSERT(std::isfinite(value));
  return to_text(value == 0 ? 0.0 : value);
}

std::string json_of(bool value) { return value ? "true" : "false"; }

std::string json_of(const scene::Rgb& c) { return "[" + of_float(c.r) + ", " + of_float(c.g) + ", " + of_float(c.b) + "]"; }

std::string json_of(const Vec3& v) { return "[" + json_of(v.x) + ", " + json_of(v.y) + ", " + json_of(v.z) + "]"; }

std::string json_of(const std::array<double, 2>& range) { return "[" + json_of(range[0]) + ", " + json_of(range[1]) + "]"; }

std::string json_of(const ColorPoints& points) {
  return list_of(points, [](const auto& p) {
    return "[" + json_of(p.value) + ", " + of_float(p.color.r) + ", " + of_float(p.color.g) + ", " + of_float(p.color.b) + "]";
  });
}

std::string json_of(const OpacityPoints& points) {
  return list_of(points, [](const auto& p) { return "[" + json_of(p.value) + ", " + json_of(p.alpha) + "]"; });
}

std::string json_of(const json::Node& node) {
  switch (node.kind) {
    case json::Kind::null:
      return "null";
    case json::Kind::boolean:
      return json_of(node.boolean);
    case json::Kind::number:
      return json_of(node.number);
    case json::Kind::string:
      return quoted(node.string);
    case json::Kind::array:
      return list_of(node.items, [](const json::Node& item) { return json_of(item); });
    case json::Kind::object:
      break;
  }
  return json_with(node, {}, {});
}

std::string json_with(const json::Node& object, const std::vector<std::string>& without,
                      const std::vector<std::pair<std::string, std::string>>& added) {
  std::string text = "{";
  const auto add = [&](const std::string& key, const std::string& value) {
    text += (text.size() > 1 ? ", " : "") + quoted(key) + ": " + value;
  };
  for (const auto& [key, node] : object.members) {
    const auto other = std::find_if(added.begin(), added.end(), [&](const auto& a) { return a.first == key; });
    if (other != added.end())
      add(key, other->second);
    else if (std::find(without.begin(), without.end(), key) == without.end())
      add(key, json_of(node));
  }
  for (const auto& [key, value] : added)
    if (object.find(key) == nullptr) add(key, value);
  return text + "}";
}

}  // namespace catena::app
