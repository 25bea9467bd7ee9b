// SPDX-License-Identifier: MIT
/// catena documents man FOLDER | completion FILE: manual pages and the shell completion, generated from the descriptions of all commands.
/// Meant for packagers of Catena: `catena --help` does not list it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <memory>

#include "engine/app/cli/command.h"
#include "engine/app/cli/command_reference.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "engine/base/version.h"

namespace catena::app {
namespace {

const auto kAll = [](const CLI::App*) { return true; };

/// Escapes text for roff: a control character at the beginning of a line, and hyphens.
std::string roff(const std::string& text) {
  std::string out = !text.empty() && (text[0] == '.' || text[0] == '\'') ? "\\&" : "";
  for (const char c : text) {
    if (c == '\\' || c == '-') out += '\\';
    out += c == '\\' ? 'e' : c;
    if (c == '\n') out += "\\&";
  }
  return out;
}

/// Returns the name of an option or argument: "-o,--output FILE", "SCENE".
std::string roff_name(const CLI::Option& option) {
  std::string names;
  for (const std::string& name : option.get_snames()) names += (names.empty() ? "" : ", ") + ("\\fB" + roff("-" + name) + "\\fR");
  for (const std::string& name : option.get_lnames()) names += (names.empty() ? "" : ", ") + ("\\fB" + roff("--" + name) + "\\fR");
  if (names.empty()) return "\\fI" + roff(option.get_name(true)) + "\\fR";
  const std::string value = value_name(option);
  return names + (value.empty() ? "" : " \\fI" + roff(value) + "\\fR");
}

/// Returns the accepted values and the default of an option: "; on, off (default: off)".
std::string range_note(const CLI::Option& option) {
  std::string words = accepted_range(option);
  words.erase(std::remove(words.begin(), words.end(), '`'), words.end());
  if (!words.empty()) words.insert(0, "; ");
  return option.get_default_str().empty() ? words : words + " (default: " + option.get_default_str() + ")";
}

void add_options(const CLI::App& command, std::string& page) {
  for (const bool places : {true, false}) {
    std::string part;
    for (const CLI::Option* option : command.get_options())
      if (option->get_positional() == places && !option->get_group().empty())
        part += ".TP\n" + roff_name(*option) + "\n" + roff(option->get_description() + range_note(*option)) + "\n";
    if (!part.empty()) page += (places ? ".SH ARGUMENTS\n" : ".SH OPTIONS\n") + part;
  }
}

struct ManualPage {
  std::string name;  ///< "catena-study-run"
  std::string text;
};

/// Adds the manual page of a command and those of its subcommands.
void add_pages(const CLI::App& command, const std::string& name, std::vector<ManualPage>& pages) {
  std::string words = name;
  std::replace(words.begin(), words.end(), '-', ' ');
  std::string capitals = name;
  std::transform(name.begin(), name.end(), capitals.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  std::string page = ".TH " + roff(capitals) + " 1 \"\" \"catena " + kVersion + "\" \"Catena\"\n.SH NAME\n" + roff(name) + " \\- " +
                     roff(purpose(command)) + "\n.SH SYNOPSIS\n\\fB" + words + "\\fR";
  std::string parts, see;
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional())
      page += (option->get_required() ? " " : " [") + roff(option->get_name(true)) + (option->get_required() ? "" : "]");
  if (!command.get_subcommands(kAll).empty()) page += command.get_require_subcommand_min() > 0 ? " \\fICOMMAND\\fR" : " [\\fICOMMAND\\fR]";
  page += " [\\fIOPTIONS\\fR]\n";
  for (const CLI::App* part : command.get_subcommands(kAll)) {
    if (part->get_group().empty()) continue;
    const std::string own = name + "-" + part->get_name();
    parts += ".TP\n\\fB" + roff(part->get_name()) + "\\fR\n" + roff(part->get_description()) + "; " + roff(own) + "(1)\n";
    see += (see.empty() ? "" : ", ") + ("\\fB" + roff(own) + "\\fR(1)");
    add_pages(*part, own, pages);
  }
  if (!parts.empty()) page += ".SH COMMANDS\n" + parts;
  add_options(command, page);
  page +=
      ".SH EXIT STATUS\n0: success. 2: the input cannot be used; one line on standard error says why, and no output file is written. 1: a "
      "system failure.\n";
  page += ".SH SEE ALSO\n" + (see.empty() ? std::string("\\fBcatena\\fR(1)") : see) + "\n";
  pages.push_back({name, page});
}

Outcome write_manual(const CLI::App& program, const std::string& folder) {
  std::vector<ManualPage> pages;
  add_pages(program, "catena", pages);
  std::vector<OutputFile> files;
  std::vector<OutputFile*> all;
  files.reserve(pages.size());
  for (const ManualPage& page : pages) {
    CATENA_TRY(OutputFile file, OutputFile::open(folder + "/" + page.name + ".1"));
    file.write(page.text);
    files.push_back(std::move(file));
    all.push_back(&files.back());
  }
  return commit_all(all);
}

/// Adds "case" branches: the words that can follow each command.
void add_words(const CLI::App& command, const std::string& words, std::string& cases) {
  std::string offered;
  for (const CLI::App* part : command.get_subcommands(kAll)) {
    if (part->get_group().empty()) continue;
    offered += part->get_name() + " ";
    add_words(*part, words + " " + part->get_name(), cases);
  }
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) offered += "--" + name + " ";
  cases += "    \"" + words + "\") words=\"" + offered + "\" ;;\n";
}

/// Writes the completion for bash, which zsh can load, too (bashcompinit): commands and their options, and files elsewhere.
Outcome write_completion(const CLI::App& program, const std::string& path) {
  std::string cases;
  add_words(program, "catena", cases);
  CATENA_TRY(OutputFile file, OutputFile::open(path));
  file.write(
      "# Completion of catena's commands and options, made by `catena documents completion`.\n"
      "_catena() {\n  local current=${COMP_WORDS[COMP_CWORD]} at=catena words= i\n"
      "  for ((i = 1; i < COMP_CWORD && i < 3; ++i)); do\n    [[ ${COMP_WORDS[i]} =~ ^[a-z]+$ ]] || break\n"
      "    case \"$at ${COMP_WORDS[i]}\" in\n");
  std::string known;
  for (const CLI::App* command : program.get_subcommands(kAll)) {
    if (command->get_group().empty()) continue;
    known += (known.empty() ? "" : "|") + ("\"catena " + command->get_name() + "\"");
    for (const CLI::App* part : command->get_subcommands(kAll)) known += "|\"catena " + command->get_name() + " " + part->get_name() + "\"";
  }
  file.write("      " + known + ") at+=\" ${COMP_WORDS[i]}\" ;;\n      *) break ;;\n    esac\n  done\n  case $at in\n" + cases +
             "  esac\n  COMPREPLY=()\n  [[ $current == -* || $at == catena || $words != -* ]] &&\n"
             "    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n"
             "  [[ $current == -* || $at == catena ]] || mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -- \"$current\")\n}\n"
             "complete -o filenames -F _catena catena\n");
  return file.commit();
}

struct DocumentOptions {
  std::string folder, file;
};

}  // namespace

void add_documents(CLI::App& program, CommandAction& chosen) {
  auto options = std::make_shared<DocumentOptions>();
  CLI::App* command = program.add_subcommand("documents", "writes manual pages and shell completion, for packages")->group("");
  command->require_subcommand(1);
  CLI::App* man = command->add_subcommand("man", "writes a manual page for every command");
  man->add_option("FOLDER", options->folder, "folder for the pages")->required();
  man->callback([&chosen, &program, options] { chosen = [&program, options] { return write_manual(program, options->folder); }; });
  CLI::App* completion = command->add_subcommand("completion", "writes the completion for bash");
  completion->add_option("FILE", options->file, "file to write")->required();
  completion->callback([&chosen, &program, options] { chosen = [&program, options] { return write_completion(program, options->file); }; });
}

}  // namespace catena::app
