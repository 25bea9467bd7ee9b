// SPDX-License-Identifier: MIT
#include "engine/app/cli/command_reference.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <set>

#include "engine/app/cli/command.h"
#include "engine/app/cli/option_types.h"
#include "engine/io/formats.h"

namespace catena::app {

namespace {

constexpr int kMaxFixedValues = 16;  // an option that takes more values may be repeated

std::string in_code(const std::string& text) { return "`" + text + "`"; }

std::string replace_all(std::string text, const std::string& old_text, const std::string& new_text) {
  for (std::size_t at = text.find(old_text); at != std::string::npos; at = text.find(old_text, at + new_text.size()))
    text.replace(at, old_text.size(), new_text);
  return text;
}

std::vector<const CLI::App*> visible_subcommands(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App* part) { return !part->get_group().empty(); });
}

/// "largest step" -> "Largest step."
std::string to_sentence(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text.empty() || text.ends_with('.') ? text : text + ".";
}

/// An option's description without its default value "(default: VALUE)".
struct Description {
  std::string meaning, default_value;
};

Description split_description(const std::string& text) {
  constexpr std::string_view kBegin = " (default: ";
  const std::size_t at = text.rfind(kBegin);
  if (at == std::string::npos || !text.ends_with(')')) return {text, {}};
  return {text.substr(0, at), text.substr(at + kBegin.size(), text.size() - at - kBegin.size() - 1)};
}

/// Returns the name by which examples and synopses give an option: "-o", "--size"; empty for an argument.
std::string short_name(const CLI::Option& option) {
  if (!option.get_snames().empty()) return "-" + option.get_snames().front();
  return option.get_lnames().empty() ? "" : "--" + option.get_lnames().front();
}

bool is_flag(const CLI::Option& option) { return option.get_items_expected_max() == 0; }

bool is_repeatable(const CLI::Option& option) { return option.get_items_expected_max() > kMaxFixedValues; }

/// Returns the choices of "{on,off}".
std::vector<std::string> choices(const std::string& range) {
  std::vector<std::string> words;
  if (!range.starts_with('{') || !range.ends_with('}')) return words;
  std::string word;
  for (const char c : range.substr(1)) {
    if (c == ',' || c == '}') {
      words.push_back(word.substr(std::min(word.find_first_not_of(' '), word.size())));
      word.clear();
    } else {
      word += c;
    }
  }
  return words;
}

/// Returns what the validators of an option accept, as they say it: "INT in [1 - 16]", "{on,off}".
std::string raw_range(const CLI::Option& option) {
  const std::string full = option.get_type_name();
  const OptionType* type = find_option_type(full);
  return type == nullptr || full.size() == type->name.size() ? "" : full.substr(type->name.size() + 1);
}

/// "[1,1,1]" -> "1 1 1"
std::string default_words(const CLI::Option& option) {
  std::string text = option.get_default_str();
  if (text.starts_with('[') && text.ends_with(']')) text = replace_all(text.substr(1, text.size() - 2), ",", " ");
  return text;
}

/// Returns a literal that shows the use of an option: "--size 640x480".
std::string example(const CLI::Option& option, const OptionType* type) {
  const std::string name = short_name(option);
  if (is_flag(option)) return name;
  std::string value = type == nullptr ? "" : std::string(type->example);
  const std::vector<std::string> words = choices(raw_range(option));
  for (auto word = words.rbegin(); word != words.rend(); ++word)
    if (*word != option.get_default_str() && (value.empty() || type->name == "PART")) value = *word;
  if (option.get_delimiter() == ',' && words.size() > 1) value = words[0] + "," + words[1];
  if (value.find(' ') != std::string::npos && is_repeatable(option)) value = "\"" + value + "\"";
  const std::string own_name = option.get_lnames().empty() ? "file" : option.get_lnames().front();
  return (name.empty() ? "" : name + " ") + replace_all(value, "*", own_name);
}

std::string takes(const CLI::Option& option, const OptionType* type) {
  if (is_flag(option)) return "flag";
  const std::string what = type == nullptr ? "?" : std::string(type->input_kind);
  if (!is_repeatable(option)) return what;
  if (option.get_delimiter() == ',') return what + "s, separated by commas";
  return what + (option.get_positional() ? ", one or more" : ", may be repeated");
}

/// Returns the options that `option` excludes or needs, as sentences.
std::string relations(const CLI::Option& option) {
  std::set<std::string> sentences;  // sorted: CLI11 orders by address
  for (const CLI::Option* other : option.get_excludes()) sentences.insert(" Not with " + in_code(short_name(*other)) + ".");
  for (const CLI::Option* other : option.get_needs()) sentences.insert(" Needs " + in_code(short_name(*other)) + ".");
  std::string text;
  for (const std::string& sentence : sentences) text += sentence;
  return text;
}

std::string table_row(const CLI::Option& option) {
  const OptionType* type = find_option_type(option.get_type_name());
  std::string names;
  for (const std::string& name : option.get_snames()) names += in_code("-" + name) + ", ";
  for (const std::string& name : option.get_lnames()) names += "`--" + name + (is_flag(option) ? "" : " " + value_name(option)) + "`";
  if (names.empty()) names = in_code(option.get_name(true));
  const Description description = split_description(option.get_description());
  std::string range = accepted_range(option);
  if (range.empty() && type != nullptr && !is_flag(option)) range = type->range;
  std::string otherwise = description.default_value;
  if (option.get_required())
    otherwise = "required";
  else if (is_flag(option))
    otherwise = "off";
  else if (!option.get_default_str().empty())
    otherwise = in_code(default_words(option));
  else if (otherwise.empty())
    otherwise = "none";
  std::string row = "|";
  for (const std::string& cell : {names, takes(option, type), type == nullptr || is_flag(option) ? "" : std::string(type->unit), range,
                                  otherwise, in_code(example(option, type)), to_sentence(description.meaning) + relations(option)})
    row += " " + replace_all(cell, "|", "\\|") + " |";
  return row + "\n";
}

std::string option_table(const CLI::App& command, const std::string& name) {
  std::string text = to_sentence(purpose(command)) + "\n\n```\ncatena " + name + synopsis(command) + "\n```\n\n";
  text += "| option | takes | unit | range | default | example | meaning |\n|---|---|---|---|---|---|---|\n";
  for (const bool arguments : {true, false})
    for (const CLI::Option* option : command.get_options())
      if (option->get_positional() == arguments && !option->get_group().empty() && option != command.get_help_ptr())
        text += table_row(*option);
  return text;
}

void add_tables(const CLI::App& command, const std::string& name, std::vector<std::pair<std::string, std::string>>& tables) {
  tables.emplace_back(name, option_table(command, name));
  for (const CLI::App* part : visible_subcommands(command)) add_tables(*part, name + " " + part->get_name(), tables);
}

}  // namespace

std::string value_name(const CLI::Option& option) {
  if (is_flag(option)) return {};
  const OptionType* type = find_option_type(option.get_type_name());
  return type == nullptr ? option.get_type_name() : std::string(type->name);
}

std::string accepted_range(const CLI::Option& option) {
  const std::string range = raw_range(option);
  std::string listed;
  for (const std::string& word : choices(range)) listed += (listed.empty() ? "" : ", ") + in_code(word);
  if (!listed.empty()) return listed;
  const std::size_t at = range.find(" in [");  // of CLI::Range: "FLOAT in [1 - 1e+09]"
  const std::string limits = at == std::string::npos ? range : replace_all(range.substr(at + 5, range.size() - at - 6), " - ", " to ");
  return replace_all(limits, "e+0", "e");
}

std::string synopsis(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) continue;
    const std::string name = option->get_name(true) + (is_repeatable(*option) ? "..." : "");
    text += option->get_required() ? " " + name : " [" + name + "]";
  }
  for (const CLI::Option* option : command.get_options())
    if (!option->get_positional() && option->get_required()) text += " " + short_name(*option) + " " + value_name(*option);
  if (!visible_subcommands(command).empty()) text += command.get_require_subcommand_min() > 0 ? " COMMAND" : " [COMMAND]";
  return text + " [OPTIONS]";
}

std::string purpose(const CLI::App& command) {
  std::string text = command.get_description();
  if (text.starts_with("Catena: ")) text.erase(0, 8);
  if (text.ends_with('.')) text.pop_back();
  return text;
}

std::vector<std::pair<std::string, std::string>> option_tables() {
  CLI::App program;
  CommandAction chosen;
  int exit_code = 0;
  std::vector<std::string> plugins;
  add_commands(program, chosen, exit_code, plugins);
  std::vector<std::pair<std::string, std::string>> tables;
  for (const CLI::App* command : visible_subcommands(program)) add_tables(*command, command->get_name(), tables);
  return tables;
}

std::string format_table() {
  std::string table = "| extensions | format | read as | written from |\n|---|---|---|---|\n";
  for (const io::Format& format : io::formats()) {
    std::string extensions, read, written;
    for (const std::string_view extension : format.extensions)
      extensions += (extensions.empty() ? "" : ", ") + in_code(std::string(extension));
    for (const auto& [kind, word] : {std::pair{io::DataKind::volume, "volume"},
                                     {io::DataKind::mesh, "mesh"},
                                     {io::DataKind::curves, "curves"},
                                     {io::DataKind::points, "points"}}) {
      if (format.reads(kind)) read += (read.empty() ? "" : ", ") + std::string(word);
      if (format.writes(kind)) written += (written.empty() ? "" : ", ") + std::string(word);
    }
    table += "| " + extensions + " | " + std::string(format.name) + " | " + read + " | " + written + " |\n";
  }
  return table;
}

}  // namespace catena::app
