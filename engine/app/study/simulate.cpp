/// catena study simulate STUDY.json --subjects N -o DIR [--shard I/N] [--record]
#include <CLI/CLI.hpp>

#include "engine/app/study/study_command.h"

namespace catena::app {

void add_study_simulate(CLI::App&, Work&) {}

}  // namespace catena::app
