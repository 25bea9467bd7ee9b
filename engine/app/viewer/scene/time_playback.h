// SPDX-License-Identifier: MIT
/// Playback of a scene's time steps (engine/scene/time_steps.h), in a window or for a browser. Frame thread.
#pragma once
#include <cstdint>

#include "engine/app/viewer/scene/scene_model.h"

namespace catena::app {

/// Shows a requested step, or the steps one after the other.
class TimePlayback {
 public:
  bool is_playing = false;  ///< True: the steps advance by themselves.

  /// Shows a step; the index wraps around. An Error if it cannot be loaded: the current step stays and playback stops.
  Outcome show(SceneModel& scene, int step);
  /// Shows the next step if playback is on and its time has come. A step that is not loaded yet is prefetched without blocking; after 30 s
  /// it is loaded synchronously. An Error as in show().
  Outcome advance(SceneModel& scene);

 private:
  std::int64_t last_step_ns_ = 0;
  int prefetched_step_ = -1;  ///< The last step that was requested for prefetching; -1: none.
};

}  // namespace catena::app
