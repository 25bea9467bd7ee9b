/// "--record FILE", or the window's switch: every tick of a session, written beside the servo. Frame side.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/app/haptics/haptic_device_setup.h"
#include "haptics/servo/log/writer.h"

namespace catena::app {

/// What a recording says of the scene, beside its programs.
struct RecordedScene {
  std::string path;                        ///< relative paths in the text are relative to it
  std::string text;                        ///< as it is now, saved or not
  std::vector<std::string> field_options;  ///< --field options
  std::vector<std::string> input_files;    ///< files that it names: not to be overwritten
  std::string description{};               ///< what is recorded: LogHeader::about
};

class Recording {
 public:
  /// Nothing is recorded where `path` is empty. `program`: that with which the servo begins, or which it runs.
  static Result<Recording> open(const std::string& path, RecordedScene scene, const HapticDeviceSetup& hand,
                                const haptics::HapticProgram& program);

  /// Another program, before the servo gets it. `text`: the scene's, now.
  void add_program(const haptics::HapticProgram& program, const std::string& text);

  /// Of a picture that a headset is about to show.
  void add_poses(const haptics::log::LogPoses& poses) {
    if (writer_) writer_->add_poses(poses);
  }

  /// For ServoOptions::sink or Servo::set_sink; nullptr: none.
  haptics::TickSink* sink() const { return writer_.get(); }
  bool is_recording() const { return writer_ != nullptr; }
  bool has_failed() const { return writer_ && writer_->status().failed; }
  haptics::log::LogStatus status() const { return writer_ ? writer_->status() : haptics::log::LogStatus{}; }
  const std::string& path() const { return path_; }
  double seconds() const;
  /// After the servo has stopped or let go of the sink. Nothing is recorded any more.
  Outcome finish();

 private:
  std::unique_ptr<haptics::log::LogWriter> writer_;
  std::string path_, text_;
  std::int64_t start_ns_ = 0;
};

}  // namespace catena::app
