/// TimeStepWatcher has new steps in time looked for beside the picture (engine/scene/follow_files.h), in a window or for a browser:
/// `--follow`. Who looks at the newest step is taken to the next one; who looks at another stays there. Frame thread; the looking is on a
/// thread of its own.
#pragma once
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "engine/app/viewer/scene/time_playback.h"
#include "engine/scene/follow_files.h"

namespace catena::app {

class TimeStepWatcher {
 public:
  explicit TimeStepWatcher(bool on) : is_enabled_(on) {}
  /// Takes what was found, and has it looked for again after a while. True: there are more steps.
  Result<bool> poll(SceneModel& scene, TimePlayback& steps);

 private:
  bool is_enabled_;
  std::int64_t last_poll_ns_ = 0;
  std::vector<scene::FollowedSource> found_;
  std::atomic<bool> done_{false};
  bool is_searching_ = false, shows_newest_ = false;
  std::jthread thread_;  ///< last: it is joined before what it writes goes
};

}  // namespace catena::app
