// SPDX-License-Identifier: MIT
#include "engine/base/json_edit.h"

#include <algorithm>

namespace catena::json {
namespace {

constexpr std::size_t kNone = std::string_view::npos;

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_line_end(char c) { return c == '\n' || c == '\r'; }
bool all_space(std::string_view text) { return text.find_first_not_of(" \t\r\n") == kNone; }

// ---- positions in the text ----

/// Returns the end of the comment that begins at `at`; kNone if there is no comment.
std::size_t comment_end(std::string_view text, std::size_t at) {
  if (text.substr(at, 2) == "//") return std::min(text.find_first_of("\r\n", at), text.size());
  if (text.substr(at, 2) != "/*") return kNone;
  const std::size_t end = text.find("*/", at + 2);
  return end == kNone ? text.size() : end + 2;
}

/// Returns the offset of the next token after blanks, line ends and comments.
std::size_t next_token(std::string_view text, std::size_t at) {
  while (at < text.size()) {
    const std::size_t end = comment_end(text, at);
    if (end == kNone && !is_blank(text[at]) && !is_line_end(text[at])) break;
    at = end == kNone ? at + 1 : end;
  }
  return at;
}

/// Returns the offset after the comments that follow on the same line.
std::size_t past_line_comments(std::string_view text, std::size_t at) {
  std::size_t end_of_comments = at;
  while (at < text.size()) {
    const std::size_t end = comment_end(text, at);
    if (end == kNone && !is_blank(text[at])) break;
    at = end == kNone ? at + 1 : end_of_comments = end;
  }
  return end_of_comments;
}

std::size_t line_begin(std::string_view text, std::size_t at) {
  while (at > 0 && !is_line_end(text[at - 1])) --at;
  return at;
}
std::size_t past_blanks(std::string_view text, std::size_t at) {
  while (at < text.size() && is_blank(text[at])) ++at;
  return at;
}
std::size_t past_line_end(std::string_view text, std::size_t at) {
  if (text.substr(at, 2) == "\r\n") return at + 2;
  return at < text.size() && is_line_end(text[at]) ? at + 1 : at;
}

/// Returns true if only blanks precede `at` on its line, and this is not the first line.
bool starts_line(std::string_view text, std::size_t at) {
  const std::size_t begin = line_begin(text, at);
  return begin > 0 && past_blanks(text, begin) >= at;
}
std::string_view indentation(std::string_view text, std::size_t at) {
  const std::size_t begin = line_begin(text, at);
  return text.substr(begin, past_blanks(text, begin) - begin);
}
/// Returns the line ending of this text: LF, CR LF or CR; LF if it has only one line.
std::string_view line_end_of(std::string_view text) {
  const std::size_t at = text.find_first_of("\r\n");
  return at == kNone ? "\n" : text.substr(at, past_line_end(text, at) - at);
}

struct Item {
  std::size_t begin;    ///< offset of the key, or of the value in an array
  std::size_t key_end;  ///< end of the key, for members of an object
  std::size_t value, end;
  std::size_t comma;  ///< offset of the comma after the item; kNone for the last item
};

std::vector<Item> items_of(std::string_view text, const Node& container) {
  std::vector<Item> items;
  std::size_t at = container.begin + 1;
  const auto add = [&](const Node& value, bool member) {
    Item item{next_token(text, at), 0, value.begin, value.end, kNone};
    item.key_end = item.begin + 1;
    while (member && text[item.key_end] != '"') item.key_end += text[item.key_end] == '\\' ? 2 : 1;
    at = next_token(text, value.end);
    if (text[at] == ',') item.comma = at++;
    ++item.key_end;
    items.push_back(item);
  };
  for (const Node& value : container.items) add(value, false);
  for (const auto& [key, value] : container.members) add(value, true);
  return items;
}

// ---- insertion ----

/// Returns one step of indentation, taken from the outermost items.
std::string_view indentation_step(std::string_view text, const Node& root) {
  for (const Item& item : items_of(text, root))
    if (starts_line(text, item.begin) && !indentation(text, item.begin).empty()) return indentation(text, item.begin);
  return "  ";
}

std::string into_empty(std::string_view text, const Node& root, const Node& container, const std::string& item) {
  std::string out(text);
  const std::size_t first = container.begin + 1, close = container.end - 1;
  const std::string_view inside = text.substr(first, close - first);
  const std::size_t last = inside.find_last_not_of(" \t\r\n");
  const std::size_t at = last == kNone ? first : first + last + 1;  // after the comments of the empty container
  if (inside.find_first_of("\r\n") == kNone) {
    if (last == kNone) return out.insert(first, std::string(inside) + item);
    return out.insert(at, " " + item);
  }
  return out.insert(
      at, std::string(line_end_of(text)) + std::string(indentation(text, close)) + std::string(indentation_step(text, root)) + item);
}

/// Returns the text between the key and the value of a new member, copied from its neighbor.
std::string separator_like(std::string_view text, const Item& neighbour) {
  const std::string_view between = text.substr(neighbour.key_end, neighbour.value - neighbour.key_end);
  return between.find_first_not_of(": \t") == kNone ? std::string(between) : ": ";
}

// ---- removal ----

struct Cut {
  std::size_t begin, end;
};

/// Extends the cut by the blanks that it would leave behind; a line that would become blank is removed completely.
Cut with_blanks(std::string_view text, Cut cut) {
  const bool starts = starts_line(text, cut.begin);
  const std::size_t next = past_blanks(text, cut.end);
  const bool ends = next == text.size() || is_line_end(text[next]);
  if (starts && ends) return {line_begin(text, cut.begin), past_line_end(text, next)};
  if (!ends) return {cut.begin, next};
  while (cut.begin > 0 && is_blank(text[cut.begin - 1])) --cut.begin;
  return cut;
}

}  // namespace

Replacement rename_key(std::string_view text, const Node& container, std::size_t index, std::string_view key) {
  const Item item = items_of(text, container)[index];
  return {item.begin, item.key_end, serialize_string(key)};
}

std::string with_item_appended(std::string_view text, const Node& root, const Node& container, const std::string& key,
                               const std::string& value) {
  const std::vector<Item> items = items_of(text, container);
  if (items.empty()) return into_empty(text, root, container, key.empty() ? value : key + ": " + value);
  const Item& last = items.back();
  const std::string item = key.empty() ? value : key + separator_like(text, last) + value;
  std::string out(text);
  if (starts_line(text, last.begin)) {
    const std::string_view indent = text.substr(line_begin(text, last.begin), last.begin - line_begin(text, last.begin));
    out.insert(past_line_comments(text, last.end), std::string(line_end_of(text)) + std::string(indent) + item);
    return out.insert(last.end, ",");
  }
  std::string gap = " ";
  if (items.size() > 1) {
    const std::size_t next = items[items.size() - 2].comma + 1;
    const std::string_view between = text.substr(next, last.begin - next);
    if (between.find_first_not_of(" \t") == kNone) gap = between;
  }
  return out.insert(last.end, "," + gap + item);
}

std::string with_item_inserted(std::string_view text, std::size_t before, const std::string& value) {
  std::string gap = " ";
  if (starts_line(text, before)) gap = std::string(line_end_of(text)) + std::string(indentation(text, before));
  return std::string(text).insert(before, value + "," + gap);
}

std::string with_item_removed(std::string_view text, const Node& container, std::size_t index) {
  const std::vector<Item> items = items_of(text, container);
  const Item& item = items[index];
  std::string out(text);
  const auto cut = [&](Cut c) { out.erase(c.begin, c.end - c.begin); };
  const auto space = [&](std::size_t begin, std::size_t end) { return all_space(text.substr(begin, end - begin)); };
  if (items.size() == 1) {
    const std::size_t first = container.begin + 1, close = container.end - 1;
    const bool comments = !space(first, item.begin) || !space(item.end, close);
    cut(comments ? with_blanks(text, {item.begin, item.end}) : Cut{first, close});
  } else if (item.comma == kNone) {
    const std::size_t comma = items[index - 1].comma;
    if (space(comma + 1, item.begin)) {
      cut({comma, item.end});
    } else {
      cut(with_blanks(text, {item.begin, item.end}));
      cut({comma, comma + 1});
    }
  } else if (!space(item.end, item.comma)) {
    cut({item.comma, item.comma + 1});
    cut(with_blanks(text, {item.begin, item.end}));
  } else if (index == 0 && !starts_line(text, item.begin) && space(item.comma + 1, items[1].begin)) {
    cut({item.begin, items[1].begin});
  } else {
    cut(with_blanks(text, {item.begin, item.comma + 1}));
  }
  return out;
}

}  // namespace catena::json
