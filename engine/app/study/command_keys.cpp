// SPDX-License-Identifier: MIT
/// catena study keys [PART | --schema]: prints the keys of a study file.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "engine/app/cli/options.h"
#include "engine/app/study/study_commands.h"
#include "engine/schema/documents.h"
#include "engine/study/study.h"

namespace catena::app {

namespace {

Outcome print_study_keys(const std::string& part) {
  CATENA_TRY(const std::string text, schema::format_keys(study::study_components(), part, "study keys", "a study", "\n"));
  fmt::print("{}", text);
  return Done{};
}

/// JSON schema for editors: the top level of the file and its parts.
std::string study_schema() {
  std::vector<schema::Section> parts;
  for (const schema::Section& component : study::study_components()) {
    if (component.name != "study") {
      parts.push_back(component);
      continue;
    }
    for (const schema::Key& key : component.keys) parts.push_back({key.name, key.help, schema::Section::Layout::value, {key}});
  }
  return schema::json_schema(parts, "a study of Catena");
}

}  // namespace

void add_study_keys(CLI::App& study, CommandAction& chosen) {
  auto part = std::make_shared<std::string>();
  auto is_schema = std::make_shared<bool>(false);
  CLI::App* command = study.add_subcommand("keys", "lists the keys of a study file");
  command->add_option("PART", *part, "part whose keys are listed (default: all)")
      ->type_name("PART")
      ->check(accepted("{study,tasks,conditions,operator,questionnaire,compare,findings}"));
  command->add_flag("--schema", *is_schema, "prints the JSON Schema of studies for editors instead");
  command->callback([&chosen, part, is_schema] {
    chosen = [part, is_schema]() -> Outcome {
      if (!*is_schema) return print_study_keys(*part);
      fmt::print("{}", study_schema());
      return Done{};
    };
  });
}

}  // namespace catena::app
