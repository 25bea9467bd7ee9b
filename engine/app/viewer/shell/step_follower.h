/// StepFollower has new steps in time looked for beside the picture (engine/scene/follow.h), in a window or for a browser: `--follow`. Who
/// looks at the newest step is taken to the next one; who looks at another stays there. Frame thread; the looking is on a thread of its
/// own.
#pragma once
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "engine/app/viewer/shell/step_player.h"
#include "engine/scene/follow.h"

namespace catena::app {

class StepFollower {
 public:
  explicit StepFollower(bool on) : on_(on) {}
  /// Takes what was found, and has it looked for again after a while. True: there are more steps.
  Result<bool> run(SceneHost& scene, StepPlayer& steps);

 private:
  bool on_;
  std::int64_t last_look_ns_ = 0;
  std::vector<scene::Followed> found_;
  std::atomic<bool> done_{false};
  bool looks_ = false, newest_shown_ = false;
  std::jthread thread_;  ///< last: it is joined before what it writes goes
};

}  // namespace catena::app
