// SPDX-License-Identifier: MIT
/// Watches for new time steps in the background (engine/scene/follow_files.h), for a window or a browser: option `--follow`. If the newest
/// step is shown, the view advances to the next one; any other step stays. Called on the frame thread; the search has a thread of its own.
#pragma once
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "engine/app/viewer/scene/time_playback.h"
#include "engine/scene/follow_files.h"

namespace catena::app {

/// Owns the search thread.
class TimeStepWatcher {
 public:
  explicit TimeStepWatcher(bool on) : is_enabled_(on) {}
  /// Takes the result of a finished search and starts the next one after 500 ms. Returns true if time steps were added. An Error if the
  /// thread cannot be started or the step cannot be shown.
  Result<bool> poll(SceneModel& scene, TimePlayback& steps);

 private:
  bool is_enabled_;
  std::int64_t last_poll_ns_ = 0;
  std::vector<scene::FollowedSource> found_;
  std::atomic<bool> done_{false};
  bool is_searching_ = false, shows_newest_ = false;
  std::jthread thread_;  ///< Last member: joined before the members it writes are destroyed.
};

}  // namespace catena::app
