// SPDX-License-Identifier: MIT
/// The options of all commands as Markdown, generated from the commands' own descriptions: the tables of docs/reference/command-line.md.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace catena::app {

/// Returns a pair of name and text for each visible command and subcommand: {"study run", purpose, synopsis and table of its options}.
std::vector<std::pair<std::string, std::string>> option_tables();

/// Returns a table | extensions | format | read as | written from | of all file formats.
std::string format_table();

/// Returns what an option takes, as `--help` names it: "MB"; empty for a flag.
std::string value_name(const CLI::Option& option);
/// Returns the accepted values of an option as Markdown: "1 to 1000", "`on`, `off`"; empty where the option states none.
std::string accepted_range(const CLI::Option& option);
/// Returns the names of the required and optional arguments and of the required options: " SOURCE... -o IMAGE [OPTIONS]".
std::string synopsis(const CLI::App& command);
/// Returns a command's description as a sentence without its full stop.
std::string purpose(const CLI::App& command);

}  // namespace catena::app
