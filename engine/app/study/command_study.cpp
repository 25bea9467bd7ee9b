// SPDX-License-Identifier: MIT
/// catena study simulate|run|merge|scene|keys|analyse|power: an experiment described by a file (docs/reference/study.md). One source file
/// per subcommand.
#include <CLI/CLI.hpp>

#include "engine/app/study/study_commands.h"

namespace catena::app {

void add_study(CLI::App& program, CommandAction& chosen) {
  CLI::App* command = program.add_subcommand("study", "runs a user study described by a file, and analyses the data of the study");
  command->require_subcommand(1);
  add_study_simulate(*command, chosen);
  add_study_run(*command, chosen);
  add_study_merge(*command, chosen);
  add_study_scene(*command, chosen);
  add_study_keys(*command, chosen);
  add_study_analyze(*command, chosen);
  add_study_power(*command, chosen);
}

}  // namespace catena::app
