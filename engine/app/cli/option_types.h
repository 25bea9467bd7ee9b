// SPDX-License-Identifier: MIT
/// Value types of command-line options: their type names in `--help` (CLI::Option::type_name), with unit, range and example.
/// docs/reference/command-line.md is generated from them.
#pragma once
#include <string>
#include <string_view>

namespace catena::app {

/// One kind of value that options take.
struct OptionType {
  std::string_view name;        ///< Type name in `--help`: "MB"
  std::string_view input_kind;  ///< What the user types: "number"
  std::string_view unit;        ///< Empty: none
  std::string_view range;       ///< Accepted values where the option states none
  std::string_view example;     ///< "4096"; "*" stands for the option's name
  bool is_number = false;       ///< An empty value is refused before any other check
};

/// Finds the value type that CLI::Option::get_type_name() begins with: "MB" in "MB:FLOAT in [1 - 1e+09]". Null: none.
const OptionType* find_option_type(std::string_view type_name);

}  // namespace catena::app
