// SPDX-License-Identifier: MIT
#include "engine/schema/documents.h"

#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena::schema {

namespace {

std::string code(const std::string& text) { return "`" + text + "`"; }

std::string form_words(const Key& key) {
  switch (key.value_type) {
    case ValueType::number:
      return "number";
    case ValueType::integer:
      return "integer";
    case ValueType::boolean:
      return "boolean";
    case ValueType::text:
      return key.role == Role::file ? "file" : key.role == Role::none ? "string" : "name";
    case ValueType::choice:
      return "word";
    case ValueType::vector:
      return std::to_string(key.count) + " numbers";
    case ValueType::color:
      return "colour";
    case ValueType::numbers:
      return "numbers";
    case ValueType::texts:
      return "names";
    case ValueType::points:
      return "positions";
    case ValueType::table:
      return "table";
    case ValueType::rotation:
      return "rotation";
    case ValueType::null:
      return "null";
    case ValueType::object:
      return "object";
    case ValueType::any_of:
      break;
  }
  if (key.alternatives.empty()) return "array or object";
  std::string all;
  for (std::size_t i = 0; i < key.alternatives.size(); ++i)
    all += (i == 0 ? "" : i + 1 == key.alternatives.size() ? " or " : ", ") + describe_type(key.alternatives[i]);
  return all;
}

/// Returns the default column: JSON values as code, descriptions as plain text.
std::string default_column(const Key& key) {
  if (key.is_required) return "required";
  const std::string& text = key.default_text;
  const bool value = !text.empty() && (text[0] == '[' || text[0] == '"' || parse_double(text));
  if (text.size() > 1 && text[0] == '"') return code(text.substr(1, text.size() - 2));
  return value ? code(text) : text;
}

/// Returns the range column: the limits of a number, or the options of a choice.
std::string range_column(const Key& key) {
  if (!key.range_text.empty()) return key.range_text;
  if (key.value_type == ValueType::choice) {
    std::string all;
    for (const std::string& w : key.options) all += (all.empty() ? "" : ", ") + code(w);
    return all;
  }
  if (key.value_type == ValueType::text && key.max_size > 0) return "at most " + std::to_string(key.max_size) + " bytes";
  return key.limits.to_string();
}

}  // namespace

std::string describe_type(const Key& key) {
  return form_words(key) + (key.accepts_field_map ? " or map" : "") + (key.accepts_widget ? " or widget" : "");
}

std::string markdown_table(const Keys& keys) {
  std::string out = "| key | type | unit | range | default | example | meaning |\n|---|---|---|---|---|---|---|\n";
  for (const Key& key : keys)
    out += "| " + code(key.name) + " | " + describe_type(key) + " | " + key.unit + " | " + range_column(key) + " | " + default_column(key) +
           " | " + code(example_value(key)) + " | " + key.help + " |\n";
  return out;
}

namespace {

using Tables = std::vector<std::pair<std::string, std::string>>;

void add_tables(const std::string& name, const Keys& keys, Tables& out) {
  if (!keys.empty()) out.emplace_back(name, markdown_table(keys));
  for (const Key& key : keys) {
    if (key.value_type == ValueType::object) add_tables(name + "." + key.name, *key.members, out);
    for (const Key& choice : key.alternatives)
      if (choice.value_type == ValueType::object) add_tables(name + "." + key.name, *choice.members, out);
  }
}

}  // namespace

Tables markdown_tables(const Section& component) {
  Tables out;
  add_tables(component.name, component.keys, out);
  for (const Variant& variant : component.variants) add_tables(component.name + "/" + variant.name, variant.keys, out);
  return out;
}

Result<std::string> format_keys(const std::vector<Section>& parts, const std::string& name, const std::string& command,
                                const std::string& document_name, const char* behind) {
  std::vector<std::string_view> names;
  std::string text;
  for (const Section& part : parts) {
    names.push_back(part.name);
    if (!name.empty() && part.name != name) continue;
    text += part.help + "\n";
    for (const auto& [title, table] : markdown_tables(part)) text.append("\n").append(title).append("\n").append(table).append(behind);
  }
  if (!text.empty()) return text;
  return Error{command + ": " + in_quotes(name) + " is not a part of " + document_name + "; one of " + catena::join_words(names) +
               " was expected" + suggestion(name, names)};
}

}  // namespace catena::schema
