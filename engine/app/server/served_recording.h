// SPDX-License-Identifier: MIT
/// ServedRecording is the recording of `catena serve`: every haptic tick from the start to the stop of the recording, in a private folder
/// below the system's temporary folder. The folder is removed at exit; if the program was killed, the next program that records removes the
/// folder because its lock is free. There is one file at a time, the newest, which pages can download; it has at most kMaxBytes. Frame
/// thread.
#pragma once
#include <optional>
#include <string>

#include "engine/app/viewer/input/haptic_session.h"
#include "engine/app/viewer/scene/scene_model.h"
#include "engine/base/folder_lock.h"

namespace catena::app {

/// The newest recording and its folder.
class ServedRecording {
 public:
  static constexpr std::uint64_t kMaxBytes = 256'000'000;

  ServedRecording() = default;
  ~ServedRecording();
  ServedRecording(const ServedRecording&) = delete;
  ServedRecording& operator=(const ServedRecording&) = delete;

  /// Starts a recording and deletes the previous one. Error: the disk cannot be written, and nothing is recorded.
  Outcome begin(const SceneModel& scene, HapticSession& hand);
  /// Ends the recording; does nothing if none is in progress.
  Outcome end(HapticSession& hand);
  /// Whether the recording has to be ended: it has exceeded kMaxBytes, or cannot be written.
  bool must_end(const HapticSession& hand) const;

  /// Name of the complete recording; empty: none.
  const std::string& name() const { return name_; }
  std::string path() const { return name_.empty() ? "" : folder_ + "/" + name_; }

 private:
  Outcome make_folder();

  std::string folder_, name_;
  std::optional<FolderLock> lock_;
  int count_ = 0;
};

}  // namespace catena::app
