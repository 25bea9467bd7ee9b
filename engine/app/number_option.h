/// "--rate", "--seconds" and their like: finite numbers within bounds. CLI11's own checks let "nan" through.
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

}  // namespace catena::app
