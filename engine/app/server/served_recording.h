/// ServedRecording is what pages of `catena serve` record: every tick of the hand, from a button to the next one, in a folder of its own
/// below the machine's temporary one that goes with the program; where the program was killed, the next one that records removes it, by the
/// lock that it does not hold any more. There is one file at a time, the newest, which pages can fetch; it has at most kMaxBytes. Frame
/// thread.
#pragma once
#include <optional>
#include <string>

#include "engine/app/viewer/input/haptic_session.h"
#include "engine/app/viewer/scene/scene_model.h"
#include "engine/base/folder_lock.h"

namespace catena::app {

class ServedRecording {
 public:
  static constexpr std::uint64_t kMaxBytes = 256'000'000;

  ServedRecording() = default;
  ~ServedRecording();
  ServedRecording(const ServedRecording&) = delete;
  ServedRecording& operator=(const ServedRecording&) = delete;

  /// In the place of the one before. An error of the disk: nothing is recorded.
  Outcome begin(const SceneModel& scene, HapticSession& hand);
  /// Nothing where none is under way.
  Outcome end(HapticSession& hand);
  /// It has to end: there is no more room, or it cannot be written.
  bool must_end(const HapticSession& hand) const;

  /// Of the one that is whole; empty: none.
  const std::string& name() const { return name_; }
  std::string path() const { return name_.empty() ? "" : folder_ + "/" + name_; }

 private:
  Outcome make_folder();

  std::string folder_, name_;
  std::optional<FolderLock> lock_;
  int count_ = 0;
};

}  // namespace catena::app
