// SPDX-License-Identifier: MIT
/// The subcommands of `catena study`: each function adds one to `study` and sets `chosen` if the user selected it.
#pragma once
#include "engine/app/cli/command.h"

namespace catena::app {

void add_study_simulate(CLI::App& study, CommandAction& chosen);
void add_study_run(CLI::App& study, CommandAction& chosen);
void add_study_merge(CLI::App& study, CommandAction& chosen);
void add_study_scene(CLI::App& study, CommandAction& chosen);
void add_study_keys(CLI::App& study, CommandAction& chosen);
void add_study_analyze(CLI::App& study, CommandAction& chosen);
void add_study_power(CLI::App& study, CommandAction& chosen);

}  // namespace catena::app
