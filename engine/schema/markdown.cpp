#include "engine/schema/documents.h"

#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena::schema {

namespace {

std::string code(const std::string& text) { return "`" + text + "`"; }

std::string form_words(const Key& key) {
  switch (key.form) {
    case Form::number:
      return "number";
    case Form::integer:
      return "integer";
    case Form::boolean:
      return "boolean";
    case Form::text:
      return key.role == Role::file ? "file" : key.role == Role::none ? "string" : "name";
    case Form::word:
      return "word";
    case Form::vector:
      return std::to_string(key.count) + " numbers";
    case Form::color:
      return "colour";
    case Form::numbers:
      return "numbers";
    case Form::texts:
      return "names";
    case Form::places:
      return "places";
    case Form::table:
      return "table";
    case Form::rotation:
      return "rotation";
    case Form::null:
      return "null";
    case Form::object:
      return "object";
    case Form::any_of:
      break;
  }
  if (key.choices.empty()) return "array or object";
  std::string all;
  for (std::size_t i = 0; i < key.choices.size(); ++i)
    all += (i == 0 ? "" : i + 1 == key.choices.size() ? " or " : ", ") + type_words(key.choices[i]);
  return all;
}

/// JSON values stand as code, words do not.
std::string fallback_words(const Key& key) {
  if (key.is_required) return "required";
  const std::string& text = key.fallback;
  const bool value = !text.empty() && (text[0] == '[' || text[0] == '"' || parse_double(text));
  if (text.size() > 1 && text[0] == '"') return code(text.substr(1, text.size() - 2));
  return value ? code(text) : text;
}

/// A word's words stand where a number's range does.
std::string range_words(const Key& key) {
  if (!key.range.empty()) return key.range;
  if (key.form == Form::word) {
    std::string all;
    for (const std::string& w : key.words) all += (all.empty() ? "" : ", ") + code(w);
    return all;
  }
  if (key.form == Form::text && key.most > 0) return "at most " + std::to_string(key.most) + " bytes";
  return key.limits.words();
}

}  // namespace

std::string type_words(const Key& key) {
  return form_words(key) + (key.follows_field ? " or map" : "") + (key.follows_widget ? " or widget" : "");
}

std::string markdown_table(const Keys& keys) {
  std::string out = "| key | type | unit | range | default | meaning |\n|---|---|---|---|---|---|\n";
  for (const Key& key : keys)
    out += "| " + code(key.name) + " | " + type_words(key) + " | " + key.unit + " | " + range_words(key) + " | " + fallback_words(key) +
           " | " + key.help + " |\n";
  return out;
}

namespace {

using Tables = std::vector<std::pair<std::string, std::string>>;

void add_tables(const std::string& name, const Keys& keys, Tables& out) {
  if (!keys.empty()) out.emplace_back(name, markdown_table(keys));
  for (const Key& key : keys) {
    if (key.form == Form::object) add_tables(name + "." + key.name, *key.inner, out);
    for (const Key& choice : key.choices)
      if (choice.form == Form::object) add_tables(name + "." + key.name, *choice.inner, out);
  }
}

}  // namespace

Tables markdown_tables(const Component& component) {
  Tables out;
  add_tables(component.name, component.keys, out);
  for (const Variant& variant : component.variants) add_tables(component.name + "/" + variant.name, variant.keys, out);
  return out;
}

Result<std::string> keys_text(const std::vector<Component>& parts, const std::string& name, const std::string& command,
                              const std::string& whole, const char* behind) {
  std::vector<std::string_view> names;
  std::string text;
  for (const Component& part : parts) {
    names.push_back(part.name);
    if (!name.empty() && part.name != name) continue;
    text += part.help + "\n";
    for (const auto& [title, table] : markdown_tables(part)) text.append("\n").append(title).append("\n").append(table).append(behind);
  }
  if (!text.empty()) return text;
  return Error{command + ": " + in_quotes(name) + " is no part of " + whole + "; one of " + catena::joined(names) + " was expected" +
               suggestion(name, names)};
}

}  // namespace catena::schema
