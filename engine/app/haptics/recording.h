// SPDX-License-Identifier: MIT
/// Recording of every tick of a session: --record FILE, or the viewer's switch. Written by a thread other than the haptic thread. Frame
/// thread.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/app/haptics/haptic_device_setup.h"
#include "haptics/servo/log/writer.h"

namespace catena::app {

/// The scene as stored in a recording, in addition to its programs.
struct RecordedScene {
  std::string path;                        ///< Relative paths in the text are relative to this file
  std::string text;                        ///< Current text of the scene, saved or not
  std::vector<std::string> field_options;  ///< Values of the --field options
  std::vector<std::string> input_files;    ///< Files that the scene names, which the recording must not overwrite
  std::string description{};               ///< Description of what is recorded (LogHeader::about)
};

/// A recording in progress, or none.
class Recording {
 public:
  /// Starts a recording; an empty `path` records nothing. `program`: the program that the servo starts with or is running. Error: the file
  /// cannot be opened for writing.
  static Result<Recording> open(const std::string& path, RecordedScene scene, const HapticDeviceSetup& hand,
                                const haptics::HapticProgram& program);

  /// Adds a program; call it before the servo gets the program. `text`: the scene's current text.
  void add_program(const haptics::HapticProgram& program, const std::string& text);

  /// Adds the poses of an image that a headset is about to show.
  void add_poses(const haptics::log::LogPoses& poses) {
    if (writer_) writer_->add_poses(poses);
  }

  /// The sink for ServoOptions::sink or Servo::set_sink; null: nothing is recorded.
  haptics::TickSink* sink() const { return writer_.get(); }
  bool is_recording() const { return writer_ != nullptr; }
  bool has_failed() const { return writer_ && writer_->status().failed; }
  haptics::log::LogStatus status() const { return writer_ ? writer_->status() : haptics::log::LogStatus{}; }
  const std::string& path() const { return path_; }
  /// Seconds since the start; 0 if nothing is recorded.
  double seconds() const;
  /// Ends the recording; call it after the servo has stopped or has released the sink. Error: the file could not be written.
  Outcome finish();

 private:
  std::unique_ptr<haptics::log::LogWriter> writer_;
  std::string path_, text_;
  std::int64_t start_ns_ = 0;
};

}  // namespace catena::app
