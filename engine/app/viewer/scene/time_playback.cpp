// SPDX-License-Identifier: MIT
#include "engine/app/viewer/scene/time_playback.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "engine/base/clock.h"
#include "engine/io/field_cache.h"
#include "engine/scene/time_steps.h"

namespace catena::app {

Outcome TimePlayback::show(SceneModel& host, int step) {
  scene::Scene& scene = host.scene();
  const int count = scene::step_count(scene), wanted = (step % count + count) % count;
  if (count < 2 || wanted == scene.time.step) return Done{};
  for (const field::LoadRequest& request : scene::prefetch_requests(scene, wanted))
    if (const auto loaded = field::load_cached(request); !loaded) {
      is_playing = false;
      return loaded.error();
    }
  last_step_ns_ = now_ns();
  if (scene::set_step(scene, wanted)) host.mark_changed();
  return Done{};
}

Outcome TimePlayback::advance(SceneModel& host) {
  const scene::Scene& scene = std::as_const(host).scene();
  const int count = is_playing ? scene::step_count(scene) : 1;
  if (count < 2) return Done{};
  const int next = (scene.time.step + 1) % count;
  std::vector<field::LoadRequest> requests = scene::prefetch_requests(scene, next);
  const bool ready = std::all_of(requests.begin(), requests.end(), field::is_cached);
  constexpr double kLongestWaitS = 30;  // after this the step is loaded on this thread, which reports any error
  const double since_s = 1e-3 * ms_since(last_step_ns_), period_s = 1 / scene.time.steps_per_second;
  if (since_s >= period_s && (ready || since_s >= period_s + kLongestWaitS)) return show(host, next);
  if (prefetched_step_ == next) return Done{};
  prefetched_step_ = next;
  constexpr int kAhead = 3;
  for (int k = 2; k <= kAhead; ++k) {
    std::vector<field::LoadRequest> more = scene::prefetch_requests(scene, (scene.time.step + k) % count);
    std::move(more.begin(), more.end(), std::back_inserter(requests));
  }
  field::prefetch(std::move(requests));
  return Done{};
}

}  // namespace catena::app
