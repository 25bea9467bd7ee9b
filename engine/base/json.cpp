// SPDX-License-Identifier: MIT
#include "engine/base/json.h"

#include <json/json.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <utility>

#include "engine/base/memory_limit.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena::json {
namespace {

constexpr int kDeepest = 64;
constexpr std::size_t kMaxLabel = 24;  ///< maximum length of the name shown in an item's label

/// Turns offsets into 1-based line numbers; CR, LF and CRLF each end a line.
class Lines {
 public:
  explicit Lines(std::string_view text) {
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n' || (text[i] == '\r' && !(i + 1 < text.size() && text[i + 1] == '\n'))) ends_.push_back(i);
  }
  int at(std::size_t offset) const { return 1 + static_cast<int>(std::lower_bound(ends_.begin(), ends_.end(), offset) - ends_.begin()); }

 private:
  std::vector<std::size_t> ends_;
};

Error error_on_line(const std::string& file, int line, const std::string& what) {
  const std::string at = line > 0 ? file + ":" + std::to_string(line) : file;
  return Error{one_line(at.empty() ? what : at + ": " + what)};
}

/// Statistics of a text before it is parsed. Strings and comments are skipped.
struct Shape {
  std::size_t too_deep_at = std::string_view::npos;                    ///< offset at which brackets nest deeper than kDeepest
  std::size_t values = 0, containers = 0, objects = 0, line_ends = 0;  ///< for valid JSON: all values; objects and arrays among them
};

Shape shape_of(std::string_view text) {
  Shape shape;
  int depth = 0;
  bool in_word = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool was_in_word = std::exchange(in_word, false);
    if (c == '"') {
      ++shape.values;
      for (++i; i < text.size() && text[i] != '"'; ++i)
        if (text[i] == '\\') ++i;
    } else if (c == '/' && text.substr(i, 2) == "//") {
      i = std::min(text.find_first_of("\r\n", i), text.size());
      ++shape.line_ends;
    } else if (c == '/' && text.substr(i, 2) == "/*") {
      const std::size_t end = text.find("*/", i + 2);
      const std::string_view comment = text.substr(i, end == std::string_view::npos ? end : end - i);
      shape.line_ends +=
          static_cast<std::size_t>(std::count_if(comment.begin(), comment.end(), [](char e) { return e == '\n' || e == '\r'; }));
      i = end == std::string_view::npos ? text.size() : end + 1;
    } else if (c == '{' || c == '[') {
      if (++depth > kDeepest) {
        shape.too_deep_at = i;
        return shape;
      }
      ++shape.values;
      ++shape.containers;
      if (c == '{') ++shape.objects;
    } else if (c == '}' || c == ']') {
      --depth;
    } else if (c == '\n' || c == '\r') {
      ++shape.line_ends;
    } else if (c == ':' && shape.values > 0) {
      --shape.values;  // the string before the colon is a key
    } else if (c != ',' && c != ' ' && c != '\t') {
      in_word = true;
      if (!was_in_word) ++shape.values;
    }
  }
  return shape;
}

/// Replaces comments by blanks, so that they may stand wherever blanks may: the library accepts none in an empty array. Every other byte
/// keeps its value and offset. A comment without an end is kept; the library rejects it.
std::string without_comments(std::string_view text) {
  std::string cleaned(text);
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') {
      for (++i; i < text.size() && text[i] != '"'; ++i)
        if (text[i] == '\\') ++i;
      continue;
    }
    const std::string_view two = text.substr(i, 2);
    if (two != "//" && two != "/*") continue;
    const std::size_t close = two == "//" ? std::min(text.find_first_of("\r\n", i), text.size()) : text.find("*/", i + 2);
    if (close == std::string_view::npos) break;
    const std::size_t end = two == "//" ? close : close + 2;
    for (; i < end; ++i)
      if (cleaned[i] != '\n' && cleaned[i] != '\r') cleaned[i] = ' ';
    --i;
  }
  return cleaned;
}

/// Estimates the memory in bytes that parsing needs besides the text: each value in the library (a map node) and as a Node with its label;
/// the strings, keys and labels; the text without its comments; the list of line ends, which grows. Copies that readers cache later
/// replace the library's part; what they create from an object is about a kilobyte.
double bytes_to_parse(std::string_view text, const Shape& shape) {
  constexpr double kMapNode = sizeof(Json::Value) + 64, kContainer = 64, kObject = 1024, kLabel = 48, kLineEnd = 2 * 24;
  return static_cast<double>(shape.values) * (kMapNode + sizeof(Node) + kLabel) + static_cast<double>(shape.containers) * kContainer +
         static_cast<double>(shape.objects) * kObject + 5 * static_cast<double>(text.size()) +
         static_cast<double>(shape.line_ends) * kLineEnd;
}

/// Returns true for a number by JSON's grammar: -?(0|[1-9][0-9]*)(.[0-9]+)?([eE][+-]?[0-9]+)?
bool is_json_number(std::string_view text) {
  std::size_t i = 0;
  const auto digits = [&] {
    const std::size_t first = i;
    while (i < text.size() && text[i] >= '0' && text[i] <= '9') ++i;
    return i - first;
  };
  if (i < text.size() && text[i] == '-') ++i;
  const bool zero = i < text.size() && text[i] == '0';
  const std::size_t integer_digits = digits();
  if (integer_digits == 0 || (zero && integer_digits > 1)) return false;
  if (i < text.size() && text[i] == '.' && (++i, digits() == 0)) return false;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    ++i;
    if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
    if (digits() == 0) return false;
  }
  return i == text.size();
}

/// Returns the first error of jsoncpp's report, "* Line 3, Column 5", then "  MESSAGE" on the next line; later errors follow from it.
Error first_error(const std::string& file, const std::string& report) {
  int line = 1;
  const std::size_t at = report.find("Line ");
  if (at != std::string::npos) std::from_chars(report.data() + at + 5, report.data() + report.size(), line);
  std::string message = "is not JSON";
  if (const std::size_t start = report.find('\n'); start != std::string::npos) {
    const std::size_t end = report.find('\n', start + 1);
    message = std::string(trim(std::string_view(report).substr(start + 1, end == std::string::npos ? end : end - start - 1)));
  }
  if (message.size() > 200) message = message.substr(0, 200) + "...";
  while (!message.empty() && message.back() == '.') message.pop_back();
  if (message.starts_with("Duplicate key: '")) {
    const std::size_t first = message.find('\'') + 1, last = message.rfind('\'');
    return error_on_line(file, line,
                         "duplicate key " + in_quotes(std::string_view(message).substr(first, last > first ? last - first : 0)) +
                             "; each key was expected once");
  }
  if (message.ends_with("is not a number")) return error_on_line(file, line, message + "; a finite number was expected");
  return error_on_line(file, line, "is not valid JSON: " + message + "; JSON (comments allowed) was expected");
}

class Converter {
 public:
  Converter(std::string_view text, std::size_t skipped, const std::string& file)
      : text_(text), skipped_(skipped), lines_(text), file_(std::make_shared<const std::string>(file)) {}

  Result<Node> convert(const Json::Value& value, std::string label) const {
    Node node;
    node.file = file_;
    node.label = std::move(label);
    node.line = lines_.at(static_cast<std::size_t>(value.getOffsetStart()));
    node.begin = skipped_ + static_cast<std::size_t>(value.getOffsetStart());
    node.end = skipped_ + static_cast<std::size_t>(value.getOffsetLimit());
    switch (value.type()) {
      case Json::nullValue:
        break;
      case Json::booleanValue:
        node.kind = Kind::boolean;
        node.boolean = value.asBool();
        break;
      case Json::intValue:
      case Json::uintValue:
      case Json::realValue: {
        node.kind = Kind::number;
        const std::string_view word = source(value);
        const auto number = parse_double(word);
        if (!is_json_number(word) || !number || !std::isfinite(*number))
          return error_at(node, in_quotes(word) + " is not a number; a finite number was expected");
        node.number = *number;
        break;
      }
      case Json::stringValue:
        node.kind = Kind::string;
        node.string = value.asString();
        break;
      case Json::arrayValue:
        node.kind = Kind::array;
        node.items.reserve(value.size());
        for (Json::ArrayIndex i = 0; i < value.size(); ++i) {
          CATENA_TRY(Node item, convert(value[i], node.label.substr(0, kMaxLabel) + "[" + std::to_string(i) + "]"));
          node.items.push_back(std::move(item));
        }
        break;
      case Json::objectValue: {
        node.kind = Kind::object;
        // jsoncpp sorts members by key; their offsets restore the order of the file
        std::vector<Json::Value::const_iterator> order;
        order.reserve(value.size());
        for (auto it = value.begin(); it != value.end(); ++it) order.push_back(it);
        std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a->getOffsetStart() < b->getOffsetStart(); });
        node.members.reserve(order.size());
        for (const auto& it : order) {
          CATENA_TRY(Node member, convert(*it, it.name()));
          node.members.emplace_back(it.name(), std::move(member));
        }
        break;
      }
    }
    return node;
  }

 private:
  std::string_view source(const Json::Value& value) const {
    const auto start = static_cast<std::size_t>(value.getOffsetStart()), limit = static_cast<std::size_t>(value.getOffsetLimit());
    return start <= limit && limit <= text_.size() ? text_.substr(start, limit - start) : std::string_view();
  }

  std::string_view text_;
  std::size_t skipped_;  ///< length of the byte order mark before text_
  Lines lines_;
  std::shared_ptr<const std::string> file_;
};

}  // namespace

const Node* Node::find(std::string_view key) const {
  for (const auto& [name, value] : members)
    if (name == key) return &value;
  return nullptr;
}

const Node& member_or_parent(const Node& object, std::string_view key) {
  const Node* member = object.find(key);
  return member == nullptr ? object : *member;
}

Error error_at(const Node& node, const std::string& what) { return error_on_line(node.file ? *node.file : "", node.line, what); }

bool is_equal_value(const Node& a, const Node& b) {
  const auto same_member = [](const auto& x, const auto& y) { return x.first == y.first && is_equal_value(x.second, y.second); };
  return a.kind == b.kind && a.boolean == b.boolean && a.number == b.number && a.string == b.string &&
         std::equal(a.items.begin(), a.items.end(), b.items.begin(), b.items.end(), is_equal_value) &&
         std::equal(a.members.begin(), a.members.end(), b.members.begin(), b.members.end(), same_member);
}

Result<Node> parse(std::string_view text, const std::string& file) {
  const std::size_t full_size = text.size();
  text = strip_bom(text);
  const Shape shape = shape_of(text);
  CATENA_CHECK(check_text_memory_available(one_line(file), bytes_to_parse(text, shape)));
  const Lines lines(text);
  if (const std::size_t at = shape.too_deep_at; at != std::string_view::npos)
    return error_on_line(file, lines.at(at), "nests too deep; at most " + std::to_string(kDeepest) + " levels were expected");
  if (const std::size_t at = text.find('\0'); at != std::string_view::npos)
    return error_on_line(file, lines.at(at), "holds a zero byte; JSON text was expected");

  Json::CharReaderBuilder builder;
  builder["collectComments"] = false;
  builder["allowComments"] = true;
  builder["allowTrailingCommas"] = false;
  builder["rejectDupKeys"] = true;
  builder["failIfExtra"] = true;
  builder["stackLimit"] = 4 * kDeepest;
  Json::Value root;
  std::string report;
  try {
    const std::unique_ptr<Json::CharReader> reader(builder.newCharReader());
    const std::string cleaned = without_comments(text);
    if (!reader->parse(cleaned.data(), cleaned.data() + cleaned.size(), &root, &report)) return first_error(file, report);
    return Converter(text, full_size - text.size(), file).convert(root, {});
  } catch (const std::exception& e) {
    return error_on_line(file, 1, std::string("is not valid JSON: ") + e.what() + "; JSON (comments allowed) was expected");
  }
}

Result<Node> read(const std::string& path) {
  CATENA_TRY(const std::string text, read_text_file(path, "a JSON file", kMaxJsonBytes));
  return parse(text, path);
}

}  // namespace catena::json
