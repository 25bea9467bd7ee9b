/// The parts of `catena study`: each adds its subcommand to `study` and, when the user chose it, sets `chosen`.
#pragma once
#include "engine/app/command.h"

namespace catena::app {

void add_study_simulate(CLI::App& study, Work& chosen);
void add_study_run(CLI::App& study, Work& chosen);
void add_study_merge(CLI::App& study, Work& chosen);
void add_study_scene(CLI::App& study, Work& chosen);
void add_study_keys(CLI::App& study, Work& chosen);
void add_study_analyse(CLI::App& study, Work& chosen);
void add_study_power(CLI::App& study, Work& chosen);

}  // namespace catena::app
