// SPDX-License-Identifier: MIT
/// catena merge OUTPUT: makes the output of `trace` or `tradeoff` of the parts that their shards wrote.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "engine/app/batch/line_parts.h"
#include "engine/app/batch/tradeoff_parts.h"
#include "engine/app/cli/command.h"
#include "engine/base/text.h"

namespace catena::app {

namespace {

Outcome merge_parts(const std::string& output) {
  namespace fs = std::filesystem;
  std::error_code code;
  if (fs::exists(fs::path(output) / "study.json", code))
    return Error{output + ": is a data folder of a study; catena study merge was expected"};
  if (fs::is_directory(output, code)) return merge_tradeoff_parts(output);
  if (!output.ends_with(".csv"))
    return Error{in_quotes(output) + ": the table (.csv) or the folder that was given to the shards with -o was expected"};
  CATENA_TRY(const MergedLines merged, merge_line_parts(output));
  fmt::print("{}: {} line{}, {} knots, of {} part{}\n", sanitize_for_terminal(output), merged.lines, merged.lines == 1 ? "" : "s",
             merged.rows, merged.parts, merged.parts == 1 ? "" : "s");
  return Done{};
}

}  // namespace

void add_merge(CLI::App& program, CommandAction& chosen) {
  auto output = std::make_shared<std::string>();
  CLI::App* command = program.add_subcommand("merge", "makes one output of the parts that the shards of trace or tradeoff wrote");
  command->add_option("OUTPUT", *output, "table of trace or folder of tradeoff, as given to the shards with -o")
      ->type_name("OUTPUT")
      ->required();
  command->callback([&chosen, output] { chosen = [output] { return merge_parts(*output); }; });
}

}  // namespace catena::app
