// SPDX-License-Identifier: MIT
/// Playback of a scene's time steps (engine/scene/time_steps.h), in a window or for a browser. Frame thread.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/app/viewer/scene/scene_model.h"
#include "engine/geometry/flow/curve.h"

namespace catena::app {

class HapticSession;

/// Shows a requested step, or the steps one after the other.
class TimePlayback {
 public:
  bool is_playing = false;  ///< True: the steps advance by themselves.

  /// Shows a step; the index wraps around. An Error if it cannot be loaded: the current step stays and playback stops.
  Outcome show(SceneModel& scene, int step);
  /// Shows the next step if playback is on and its time has come. A step that is not loaded yet is prefetched without blocking; after 30 s
  /// it is loaded synchronously. An Error as in show().
  Outcome advance(SceneModel& scene);
  /// Shows the step nearest to the time at which the particle of a path line is at the proxy of a link with "clock": "proxy", if the scene
  /// has one that holds the hand. Not during playback. An Error as in show().
  Outcome follow_proxy(SceneModel& scene, const HapticSession& hand);

 private:
  /// Path line whose time the scene follows.
  struct ProxyClock {
    json::Node link;  ///< Node of the link
    std::optional<flow::NearestOnCurve> nearest;
    flow::CurvePtr curve;
    std::vector<double> times;  ///< Times of the scene's steps
  };
  std::optional<ProxyClock> proxy_clock_;
  std::int64_t last_step_ns_ = 0;
  int prefetched_step_ = -1;  ///< The last step that was requested for prefetching; -1: none.
};

}  // namespace catena::app
