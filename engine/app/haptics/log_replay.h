/// `catena replay --log`: runs the tick again over a recording and compares every bit of what came out, forces too.
/// Exit code 0: all equal; 1: a difference, or ticks that the recording lacks; 2: no recording, or no scene to run.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/cli/command.h"
#include "engine/app/cli/io_conflicts.h"
#include "engine/app/haptics/tick_csv.h"
#include "engine/base/result.h"
#include "haptics/servo/log/contents.h"
#include "haptics/servo/replay.h"

namespace catena::app {

struct ReplayOptions {
  std::string scene, probe, log, output, details, widgets, stats, plan;
  std::vector<std::string> fields;
};

Outcome replay_log_file(const ReplayOptions& options);

/// What the run reads beside its scene, and what it writes.
IoConflictChecker replay_files(const ReplayOptions& options);
/// `more`: members behind the others ("\"widgets\": {..}"), or none.
std::string replay_stats_json(const haptics::ReplayStats& stats, const std::string& more = {});

/// Of a scene that states no workspace: which scales were taken, one after the other; one sentence. `recorded`: they are the recording's.
std::string describe_scales(const std::vector<double>& metres_per_unit, bool recorded);

/// Between a scene and its recording: the header of a log that begins, and the programs of one that runs again.

/// What a recording of this scene begins with: its text as the file is now. For `feel --record`.
Result<haptics::log::LogHeader> make_log_header(const std::string& scene_path, const std::vector<std::string>& field_options,
                                                const std::string& device, double rate_hz);

/// Columns for every link that any program of the recording has. Reads all of it.
Result<LinkColumns> read_log_columns(const std::string& path);

/// Builds a log's programs: from the recorded text, with files relative to the recorded scene's place; or, where `scene_path` is given,
/// from that scene. `field_options` replace fields beside the recorded ones.
class LogProgramBuilder {
 public:
  LogProgramBuilder(haptics::log::LogHeader header, std::string scene_path, std::vector<std::string> field_options);

  Result<std::shared_ptr<const haptics::HapticProgram>> build(const haptics::log::LogProgram& program);
  /// The files that the header's scene names.
  Result<std::vector<std::string>> input_files();
  /// Of the scene that was read last.
  bool has_workspace() const { return scene_ && scene_->workspace.is_explicit; }

 private:
  Outcome reload_scene(const std::optional<std::string>& own_text);

  haptics::log::LogHeader header_;
  std::string scene_path_;
  bool from_file_;
  std::vector<std::string> field_options_;
  std::optional<scene::Scene> scene_;
  std::optional<std::string> own_text_;  ///< of scene_
};

/// `catena info FILE.catlog`: what a recording holds, whether it is whole.
inline bool is_log_file(const std::string& path) { return path.ends_with(".catlog"); }
Outcome print_log_info(const std::string& path);

}  // namespace catena::app
