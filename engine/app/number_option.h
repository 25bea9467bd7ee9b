/// "--rate", "--seconds" and their like: finite numbers within bounds. CLI11's own checks let "nan" through, print bounds of 309 digits,
/// and it takes an empty word for 0 behind them: refuse_empty_numbers.
#pragma once
#include <CLI/CLI.hpp>
#include <limits>
#include <string>

#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena::app {

inline CLI::Validator number_between(double least, double most) {
  return CLI::Validator(
      [least, most](const std::string& text) -> std::string {
        const auto value = parse_double(text);
        if (value && *value >= least && *value <= most) return {};
        const std::string range =
            most < std::numeric_limits<double>::max() ? "from " + to_text(least) + " to " + to_text(most) : "of at least " + to_text(least);
        return in_quotes(text) + " is out of range; a finite number " + range + " was expected";
      },
      "");
}

inline CLI::Validator number_at_least(double least) { return number_between(least, std::numeric_limits<double>::max()); }

inline CLI::Validator number_above_zero() {
  return CLI::Validator(
      [](const std::string& text) -> std::string {
        const auto value = parse_double(text);
        if (value && *value > 0 && *value <= std::numeric_limits<double>::max()) return {};
        return in_quotes(text) + " is out of range; a finite number above 0 was expected";
      },
      "");
}

/// An empty value of an option that takes numbers is said before any other check sees it. After all options of `command` are there.
inline void refuse_empty_numbers(CLI::App& command) {
  for (CLI::Option* option : command.get_options([](const CLI::Option* o) { return o->get_expected_min() > 0; })) {
    const std::string type = option->get_type_name();
    if (!type.starts_with("INT") && !type.starts_with("UINT") && !type.starts_with("FLOAT")) continue;
    option->transform(CLI::Validator(
        [](std::string& text) -> std::string { return text.empty() ? "the value is empty; a number was expected" : ""; }, ""));
  }
}

}  // namespace catena::app
