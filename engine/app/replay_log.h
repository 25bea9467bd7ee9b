/// `catena replay --log`: runs the tick again over a recording and compares every bit of what came out, forces too.
/// Exit code 0: all equal; 1: a difference, or ticks that the recording lacks; 2: no recording, or no scene to run.
#pragma once
#include <string>
#include <vector>

#include "engine/app/command.h"
#include "engine/app/run_files.h"
#include "haptics/servo/replay.h"

namespace catena::app {

struct ReplayOptions {
  std::string scene, probe, log, output, details, widgets, stats;
  std::vector<std::string> fields;
};

Outcome replay_log_file(const ReplayOptions& options);

/// What the run reads beside its scene, and what it writes.
RunFiles replay_files(const ReplayOptions& options);
/// `more`: members behind the others ("\"widgets\": {..}"), or none.
std::string replay_stats_json(const haptics::ReplayStats& stats, const std::string& more = {});

}  // namespace catena::app
