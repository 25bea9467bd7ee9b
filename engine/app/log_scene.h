/// Between a scene and its recording: the header of a log that begins, and the programs of one that runs again.
#pragma once
#include <memory>
#include <optional>

#include "engine/app/command.h"
#include "engine/app/tick_csv.h"
#include "haptics/servo/log/contents.h"

namespace catena::app {

/// What a recording of this scene begins with: its text as the file is now. For `feel --record`.
Result<haptics::log::LogHeader> log_header(const std::string& scene_path, const std::vector<std::string>& field_options,
                                           const std::string& device, double rate_hz);

/// Columns for every link that any program of the recording has. Reads all of it.
Result<LinkColumns> columns_of_log(const std::string& path);

/// Builds a log's programs: from the recorded text, with files relative to the recorded scene's place; or, where `scene_path` is given,
/// from that scene. `field_options` replace fields beside the recorded ones.
class LogScene {
 public:
  LogScene(haptics::log::LogHeader header, std::string scene_path, std::vector<std::string> field_options);

  Result<std::shared_ptr<const haptics::Program>> build(const haptics::log::LogProgram& program);
  /// The files that the header's scene names.
  Result<std::vector<std::string>> inputs();

 private:
  Outcome read(const std::optional<std::string>& own_text);

  haptics::log::LogHeader header_;
  std::string scene_path_;
  bool from_file_;
  std::vector<std::string> field_options_;
  std::optional<scene::Scene> scene_;
  std::optional<std::string> own_text_;  ///< of scene_
};

}  // namespace catena::app
