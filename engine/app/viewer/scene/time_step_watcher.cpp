// SPDX-License-Identifier: MIT
#include "engine/app/viewer/scene/time_step_watcher.h"

#include <utility>

#include "engine/base/clock.h"
#include "engine/base/threads.h"
#include "engine/scene/time_steps.h"

namespace catena::app {

Result<bool> TimeStepWatcher::poll(SceneModel& host, TimePlayback& steps) {
  constexpr double kBetweenMs = 500;
  if (!is_enabled_) return false;
  if (!is_searching_) {
    if (last_poll_ns_ != 0 && ms_since(last_poll_ns_) < kBetweenMs) return false;
    found_ = scene::followed_sources(std::as_const(host).scene());
    done_ = false;
    try {
      thread_ = std::jthread([this] {
        for (scene::FollowedSource& one : found_) scene::poll_steps(one);
        done_ = true;
      });
    } catch (const std::system_error& error) {
      last_poll_ns_ = now_ns();
      return thread_start_error("watching for new time steps", error);
    }
    is_searching_ = true;
    return false;
  }
  if (!done_) return false;
  thread_.join();
  is_searching_ = false;
  last_poll_ns_ = now_ns();
  scene::Scene& scene = host.scene();
  const int before = scene::step_count(scene);
  const bool more = scene::apply_steps(scene, found_), at_newest = scene.time.step >= before - 1 || !shows_newest_;
  if ((more && at_newest && !steps.is_playing) || !shows_newest_) CATENA_CHECK(steps.show(host, scene::step_count(scene) - 1));
  shows_newest_ = true;
  return more;
}

}  // namespace catena::app
