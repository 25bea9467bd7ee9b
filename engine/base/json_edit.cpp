// SPDX-License-Identifier: MIT
#include "engine/base/json_edit.h"

#include <algorithm>
#include <cmath>

#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena::json {
namespace {

// ---- JSON pointers ----

/// Returns the steps of a JSON pointer; nullopt if it is malformed.
std::optional<std::vector<std::string>> steps_of(std::string_view pointer) {
  std::vector<std::string> steps;
  if (!pointer.empty() && pointer[0] != '/') return std::nullopt;
  for (std::size_t i = 0; i < pointer.size(); ++i) {
    const char c = pointer[i];
    if (c == '/') {
      steps.emplace_back();
    } else if (c == '~') {
      if (++i == pointer.size() || (pointer[i] != '0' && pointer[i] != '1')) return std::nullopt;
      steps.back() += pointer[i] == '0' ? '~' : '/';
    } else {
      steps.back() += c;
    }
  }
  return steps;
}

/// Returns the index that a step names: `size` for "-", else a decimal number without leading zeros; nullopt if it is neither.
std::optional<std::size_t> index_of(const std::string& step, std::size_t size) {
  if (step == "-") return size;
  const bool digits = !step.empty() && step.size() < 10 && step.find_first_not_of("0123456789") == std::string::npos;
  if (!digits || (step.size() > 1 && step[0] == '0')) return std::nullopt;
  return std::stoul(step);
}

/// Result of following a JSON pointer as far as its nodes exist.
struct Walk {
  std::vector<std::string> steps;
  const Node* at = nullptr;
  const Node* parent = nullptr;
  std::size_t taken = 0;
  std::size_t index = 0;  ///< index of `at` in its parent; if the step is missing, the index where it would be inserted
  bool arrived() const { return taken == steps.size(); }
};

Result<Walk> walk(const Node& root, std::string_view pointer) {
  const auto steps = steps_of(pointer);
  if (!steps) return error_at(root, in_quotes(pointer) + " is no place; a JSON pointer, /KEY/INDEX, was expected");
  Walk w{*steps, &root};
  for (; !w.arrived(); ++w.taken) {
    const std::string& step = w.steps[w.taken];
    const Node& node = *w.at;
    const auto failed = [&](const std::string& what) { return error_at(node, in_quotes(pointer) + ": " + what); };
    if (node.kind == Kind::object) {
      const auto it = std::find_if(node.members.begin(), node.members.end(), [&](const auto& m) { return m.first == step; });
      w.index = static_cast<std::size_t>(it - node.members.begin());
      if (it == node.members.end()) return w;
      w.at = &it->second;
    } else if (node.kind == Kind::array) {
      const auto index = index_of(step, node.items.size());
      if (!index || *index > node.items.size())
        return failed(in_quotes(step) + " is no item; an index up to " + std::to_string(node.items.size()) + ", or -, was expected");
      w.index = *index;
      if (*index == node.items.size()) return w;
      w.at = &node.items[*index];
    } else {
      return failed("the value before " + in_quotes(step) + " holds nothing; an object or an array was expected");
    }
    w.parent = &node;
  }
  return w;
}

/// Returns the JSON text of the value without the blanks and comments around it.
Result<std::string> value_text(const Node& root, std::string_view pointer, std::string_view value) {
  const auto parsed = parse(value, {});
  if (!parsed)
    return error_at(root, "the new value of " + in_quotes(pointer) + " " + in_quotes(value) + " is not JSON; a JSON value was expected");
  return std::string(value.substr(parsed->begin, parsed->end - parsed->begin));
}

/// Returns the text unchanged if it parses, else the parser's Error.
Result<std::string> checked(std::string text, const std::string& file) {
  if (const auto reparsed = parse(text, file); !reparsed) return reparsed.error();
  return text;
}

}  // namespace

Result<std::string> set_value(std::string_view text, const std::string& file, std::string_view pointer, std::string_view value) {
  CATENA_TRY(const Node root, parse(text, file));
  CATENA_TRY(std::string inserted, value_text(root, pointer, value));
  CATENA_TRY(const Walk w, walk(root, pointer));
  if (w.arrived()) {
    std::string out(text);
    return checked(out.replace(w.at->begin, w.at->end - w.at->begin, inserted), file);
  }
  for (std::size_t i = w.steps.size() - 1; i > w.taken; --i) {
    const std::string& step = w.steps[i];
    inserted = step == "-" || step == "0" ? "[" + inserted + "]" : "{" + serialize_string(step) + ": " + inserted + "}";
  }
  const std::string key = w.at->kind == Kind::object ? serialize_string(w.steps[w.taken]) : "";
  return checked(with_item_appended(text, root, *w.at, key, inserted), file);
}

Result<std::string> insert_item(std::string_view text, const std::string& file, std::string_view pointer, std::string_view value) {
  CATENA_TRY(const Node root, parse(text, file));
  CATENA_TRY(const std::string inserted, value_text(root, pointer, value));
  CATENA_TRY(const Walk w, walk(root, pointer));
  const Node* array = w.arrived() ? w.parent : w.taken + 1 == w.steps.size() ? w.at : nullptr;
  if (array == nullptr || array->kind != Kind::array)
    return error_at(root, in_quotes(pointer) + " is no item of an array; a place in one was expected");
  if (!w.arrived()) return checked(with_item_appended(text, root, *array, "", inserted), file);
  return checked(with_item_inserted(text, w.at->begin, inserted), file);
}

Result<std::string> remove_value(std::string_view text, const std::string& file, std::string_view pointer) {
  CATENA_TRY(const Node root, parse(text, file));
  CATENA_TRY(const Walk w, walk(root, pointer));
  if (!w.arrived() || w.parent == nullptr)
    return error_at(*w.at, in_quotes(pointer) + " is not there; a member or an item to remove was expected");
  return checked(with_item_removed(text, *w.parent, w.index), file);
}

Result<std::string> replace_ranges(std::string_view text, const std::string& file, std::vector<Replacement> edits) {
  std::ranges::sort(edits, {}, &Replacement::begin);
  std::string out;
  std::size_t at = 0;
  for (const Replacement& edit : edits) {
    out.append(text.substr(at, edit.begin - at)).append(edit.text);
    at = edit.end;
  }
  return checked(out.append(text.substr(at)), file);
}

const Node* find_value(const Node& root, std::string_view pointer) {
  const auto w = walk(root, pointer);
  return w && w->arrived() ? w->at : nullptr;
}

std::string escape_pointer_token(std::string_view key) {
  std::string out;
  for (const char c : key) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return out;
}

std::string serialize_string(std::string_view text) {
  constexpr char digits[] = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      (out += '\\') += c;
    } else if (code < 0x20) {
      out += "\\u00";
      (out += digits[code >> 4]) += digits[code & 15];
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string serialize_number(double value) {
  CATENA_ASSERT(std::isfinite(value));
  return to_text(value);
}

std::string serialize_node(const Node& node) {
  std::string text;
  const auto next = [&] { text += text.size() > 1 ? ", " : ""; };
  switch (node.kind) {
    case Kind::null:
      return "null";
    case Kind::boolean:
      return node.boolean ? "true" : "false";
    case Kind::number:
      return serialize_number(node.number);
    case Kind::string:
      return serialize_string(node.string);
    case Kind::array:
      text = "[";
      for (const Node& item : node.items) next(), text += serialize_node(item);
      return text + "]";
    case Kind::object:
      text = "{";
      for (const auto& [key, member] : node.members) next(), text += serialize_string(key) + ": " + serialize_node(member);
      return text + "}";
  }
  return text;
}

}  // namespace catena::json
