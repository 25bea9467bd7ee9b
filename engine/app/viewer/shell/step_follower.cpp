#include "engine/app/viewer/shell/step_follower.h"

#include <utility>

#include "engine/base/clock.h"
#include "engine/base/threads.h"
#include "engine/scene/steps.h"

namespace catena::app {

Result<bool> StepFollower::run(SceneHost& host, StepPlayer& steps) {
  constexpr double kBetweenMs = 500;
  if (!on_) return false;
  if (!looks_) {
    if (last_look_ns_ != 0 && ms_since(last_look_ns_) < kBetweenMs) return false;
    found_ = scene::followed(std::as_const(host).scene());
    done_ = false;
    try {
      thread_ = std::jthread([this] {
        for (scene::Followed& one : found_) scene::look_for_steps(one);
        done_ = true;
      });
    } catch (const std::system_error& error) {
      last_look_ns_ = now_ns();
      return no_thread("following the steps in time", error);
    }
    looks_ = true;
    return false;
  }
  if (!done_) return false;
  thread_.join();
  looks_ = false;
  last_look_ns_ = now_ns();
  scene::Scene& scene = host.scene();
  const int before = scene::step_count(scene);
  const bool more = scene::take_steps(scene, found_), at_newest = scene.time.step >= before - 1 || !newest_shown_;
  if ((more && at_newest && !steps.plays) || !newest_shown_) CATENA_CHECK(steps.show(host, scene::step_count(scene) - 1));
  newest_shown_ = true;
  return more;
}

}  // namespace catena::app
