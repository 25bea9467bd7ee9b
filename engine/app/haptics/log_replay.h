// SPDX-License-Identifier: MIT
/// `catena replay --log`: runs the ticks of a recording and compares every bit of the results, including forces. Exit code 0: all equal; 1:
/// a difference, or ticks that the recording lacks; 2: no recording, or no scene to run.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/cli/command.h"
#include "engine/app/cli/io_conflicts.h"
#include "engine/app/cli/options.h"
#include "engine/app/haptics/tick_csv.h"
#include "engine/base/result.h"
#include "haptics/servo/log/contents.h"
#include "haptics/servo/replay.h"

namespace catena::app {

/// Options of `catena replay`: input and output files; empty: not given.
struct ReplayOptions {
  std::string scene, probe, log, output, details, widgets, stats;
  HapticTargetOptions targets;
  std::vector<std::string> fields;
};

/// Replays options.log and writes the requested outputs. Error: bad input. Throws MachineFailure for a difference or missing ticks.
Outcome replay_log_file(const ReplayOptions& options);

/// The input files of a replay and its outputs, without the files that the scene names.
IoConflictChecker replay_files(const ReplayOptions& options);
/// The statistics as JSON. `more`: further members ("\"widgets\": {..}"), or empty.
std::string replay_stats_json(const haptics::ReplayStats& stats, const std::string& more = {});

/// One sentence on the scales that were used for a scene without an explicit workspace, in the order of use. `metres_per_unit`: device
/// meters per world unit; `recorded`: the scales are the recording's.
std::string describe_scales(const std::vector<double>& metres_per_unit, bool recorded);

/// Makes the header of a recording of this scene, with the current text of the scene file. For `feel --record`.
Result<haptics::log::LogHeader> make_log_header(const std::string& scene_path, const std::vector<std::string>& field_options,
                                                const std::string& device, double rate_hz);

/// Reads a whole recording and returns columns for every link of all of its programs.
Result<LinkColumns> read_log_columns(const std::string& path);

/// Builds the programs of a recording: from the recorded scene text, with files relative to the recorded scene's path, or from the scene
/// `scene_path` if that is not empty. `field_options` replace fields, in addition to the recorded options. One thread.
class LogProgramBuilder {
 public:
  LogProgramBuilder(haptics::log::LogHeader header, std::string scene_path, std::vector<std::string> field_options);

  /// Builds one program. Error: the scene or a file cannot be read, a plug-in is missing, or the program is not valid.
  Result<std::shared_ptr<const haptics::HapticProgram>> build(const haptics::log::LogProgram& program);
  /// The input files of the scene.
  Result<std::vector<std::string>> input_files();
  /// Whether the last scene that was read has an explicit workspace.
  bool has_workspace() const { return scene_ && scene_->workspace.is_explicit; }

 private:
  Outcome reload_scene(const std::optional<std::string>& scene_text);

  haptics::log::LogHeader header_;
  std::string scene_path_;
  bool from_file_;
  std::vector<std::string> field_options_;
  std::optional<scene::Scene> scene_;
  std::optional<std::string> scene_text_;  ///< Scene text of scene_ if a program brought its own
};

/// Whether a path is a recording.
inline bool is_log_file(const std::string& path) { return path.ends_with(".catlog"); }
/// Prints the contents of a recording and whether it is complete: `catena info FILE.catlog`.
Outcome print_log_info(const std::string& path);

}  // namespace catena::app
