// SPDX-License-Identifier: MIT
#include "engine/base/natural_sort.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace catena {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || static_cast<unsigned char>(c) >= 0x80; }

/// Part of a name: a character outside numbers, or a number.
struct Token {
  char text = 0;               ///< the character; 0 for a number
  bool minus = false;          ///< the number has a minus sign
  bool doubtful_sign = false;  ///< the sign follows a letter and may be a hyphen
  std::string digits;          ///< integer digits, without leading zeros
  bool is_integer = true;      ///< has neither a fraction nor an exponent
  double value = 0;            ///< absolute value
};

std::size_t digits_end(std::string_view name, std::size_t at) {
  while (at < name.size() && is_digit(name[at])) ++at;
  return at;
}

/// Reads the number whose first digit is at `at`; returns the offset of its end.
std::size_t read_number(std::string_view name, std::size_t at, bool decimals, Token& token) {
  std::size_t end = digits_end(name, at);
  const bool in_sequence = at >= 2 && name[at - 1] == '.' && is_digit(name[at - 2]);
  if (decimals && !in_sequence && end + 1 < name.size() && name[end] == '.' && is_digit(name[end + 1])) {
    const std::size_t fraction_end = digits_end(name, end + 1);
    const bool sequence = fraction_end + 1 < name.size() && name[fraction_end] == '.' && is_digit(name[fraction_end + 1]);
    if (!sequence) end = fraction_end, token.is_integer = false;
  }
  if (end < name.size() && (name[end] == 'e' || name[end] == 'E')) {
    const std::size_t first = end + 1 < name.size() && (name[end + 1] == '-' || name[end + 1] == '+') ? end + 2 : end + 1;
    const std::size_t exponent_end = digits_end(name, first);
    constexpr std::size_t kMaxExponentDigits = 3;
    if (exponent_end > first && exponent_end - first <= kMaxExponentDigits &&
        (exponent_end == name.size() || !is_letter(name[exponent_end])))
      end = exponent_end, token.is_integer = false;
  }
  const std::string number(name.substr(at, end - at));
  token.value = std::strtod(number.c_str(), nullptr);
  if (token.is_integer) token.digits = number.substr(std::min(number.find_first_not_of('0'), number.size()));
  return end;
}

std::vector<Token> tokens_of(std::string_view name, bool decimals) {
  std::vector<Token> tokens;
  for (std::size_t at = 0; at < name.size();) {
    Token token;
    const char previous = at == 0 ? '_' : name[at - 1];
    const bool minus = name[at] == '-' && at + 1 < name.size() && is_digit(name[at + 1]) && !is_digit(previous);
    if (minus) token.minus = true, token.doubtful_sign = is_letter(previous), ++at;
    if (name[at] == '+' && at + 1 < name.size() && is_digit(name[at + 1]) && !is_digit(previous)) ++at;
    if (is_digit(name[at]))
      at = read_number(name, at, decimals, token);
    else
      token.text = name[at++];
    tokens.push_back(std::move(token));
  }
  return tokens;
}

/// Compares two tokens, numbers by value; returns a number less than, equal to, or greater than 0.
int compare(const Token& a, const Token& b) {
  if ((a.text != 0) != (b.text != 0)) {
    const char x = a.text != 0 ? a.text : '0', y = b.text != 0 ? b.text : '0';
    return static_cast<unsigned char>(x) < static_cast<unsigned char>(y) ? -1 : 1;
  }
  if (a.text != 0) return a.text == b.text ? 0 : static_cast<unsigned char>(a.text) < static_cast<unsigned char>(b.text) ? -1 : 1;
  if (a.minus != b.minus) {
    if (a.value == 0 && b.value == 0) return 0;
    return a.minus ? -1 : 1;
  }
  int order = 0;
  if (a.is_integer && b.is_integer) {
    if (a.digits.size() != b.digits.size())
      order = a.digits.size() < b.digits.size() ? -1 : 1;
    else
      order = a.digits.compare(b.digits);
  } else {
    order = a.value < b.value ? -1 : a.value > b.value ? 1 : 0;
  }
  return a.minus ? -order : order;
}

struct Name {
  std::string text;
  std::vector<Token> tokens;
};

int compare(const Name& a, const Name& b) {
  const std::size_t common_count = std::min(a.tokens.size(), b.tokens.size());
  for (std::size_t i = 0; i < common_count; ++i)
    if (const int order = compare(a.tokens[i], b.tokens[i]); order != 0) return order;
  return a.tokens.size() == b.tokens.size() ? 0 : a.tokens.size() < b.tokens.size() ? -1 : 1;
}

/// Resolves doubtful signs: a minus after a letter is a sign only if another name has a number without a sign at the same position.
void resolve_signs(std::vector<Name>& names) {
  std::size_t longest = 0;
  for (const Name& name : names) longest = std::max(longest, name.tokens.size());
  for (std::size_t i = 0; i < longest; ++i) {
    const auto number_at = [&](const Name& name) { return i < name.tokens.size() && name.tokens[i].text == 0; };
    const bool some_without = std::ranges::any_of(names, [&](const Name& name) { return number_at(name) && !name.tokens[i].minus; });
    if (some_without) continue;
    for (Name& name : names)
      if (number_at(name) && name.tokens[i].doubtful_sign) name.tokens[i].minus = false;
  }
}

std::vector<Name> ordered(const std::vector<std::string>& texts, bool decimals) {
  std::vector<Name> names;
  for (const std::string& text : texts) names.push_back({text, tokens_of(text, decimals)});
  resolve_signs(names);
  std::ranges::sort(names, [](const Name& a, const Name& b) {
    const int order = compare(a, b);
    return order != 0 ? order < 0 : a.text < b.text;
  });
  return names;
}

}  // namespace

void natural_sort(std::vector<std::string>& names) {
  std::vector<Name> sorted = ordered(names, true);
  const auto equal_names = std::ranges::adjacent_find(sorted, [](const Name& a, const Name& b) { return compare(a, b) == 0; });
  if (equal_names != sorted.end()) {
    std::vector<Name> without_decimals = ordered(names, false);
    const auto equal_whole_names =
        std::ranges::adjacent_find(without_decimals, [](const Name& a, const Name& b) { return compare(a, b) == 0; });
    if (equal_whole_names == without_decimals.end()) sorted = std::move(without_decimals);
  }
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = std::move(sorted[i].text);
}

bool is_numbered_series(const std::vector<std::string>& names) {
  const auto text_of = [](const std::string& name) {
    std::string text;
    for (const Token& token : tokens_of(name, true)) text += token.text;  // a number adds a zero byte
    return text;
  };
  return std::ranges::all_of(names, [&](const std::string& name) { return text_of(name) == text_of(names.front()); });
}

std::array<std::string, 2> split_at_last_number(const std::string& name) {
  std::array<std::string, 2> parts{name, ""};
  for (std::size_t at = 0; at < name.size();) {
    if (!is_digit(name[at])) {
      ++at;
      continue;
    }
    Token token;
    const std::size_t end = read_number(name, at, true, token);
    parts = {name.substr(0, at), name.substr(end)};
    at = end;
  }
  return parts;
}

}  // namespace catena
