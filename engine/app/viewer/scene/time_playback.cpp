// SPDX-License-Identifier: MIT
#include "engine/app/viewer/scene/time_playback.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "engine/app/viewer/input/haptic_session.h"
#include "engine/base/clock.h"
#include "engine/io/field_cache.h"
#include "engine/scene/time_steps.h"
#include "engine/scene/unsteady_lines.h"
#include "haptics/constraints/streamline/streamline.h"

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

Outcome TimePlayback::follow_proxy(SceneModel& host, const HapticSession& hand) {
  if (is_playing) return Done{};
  scene::Scene& scene = host.scene();
  std::optional<json::Node> found;
  scene.entities.each<scene::Link>([&](scene::Entity, const scene::Link& link) {
    const json::Node* clock = link.node.find("clock");
    if (clock != nullptr && clock->string == "proxy") found = link.node;
  });
  if (!found) {
    proxy_clock_.reset();
    return Done{};
  }
  const auto& names = hand.link_names();
  const auto index = static_cast<std::size_t>(std::ranges::find(names, found->find("name")->string) - names.begin());
  const HapticState& state = hand.latest_state();
  if (index >= names.size() || index >= static_cast<std::size_t>(state.link_count) || !state.links[index].active) return Done{};
  if (!proxy_clock_ || !json::is_equal_value(proxy_clock_->link, *found)) {
    CATENA_TRY(const haptics::PathlineSpec spec, haptics::read_pathline_spec(*found));
    const scene::UnsteadyLineRequest request{scene::LineKind::path, spec.times, spec.is_cubic_in_time};
    const auto curve = scene::resolve_pathline(scene, found->find("field")->string, spec.seed, request, *found);
    if (!curve) return curve.error();
    proxy_clock_.emplace(ProxyClock{*found, flow::NearestOnCurve(*curve), *curve, {}});
    proxy_clock_->times = scene::times_of_field(scene, scene::find_field(scene, found->find("field")->string));
    if (proxy_clock_->times.empty()) proxy_clock_->times.push_back(0);
  }
  const double time = proxy_clock_->curve->time(proxy_clock_->nearest->find(state.links[index].proxy).s);
  const auto closest = std::ranges::min_element(proxy_clock_->times, {}, [&](double step) { return std::fabs(step - time); });
  return show(host, static_cast<int>(closest - proxy_clock_->times.begin()));
}

}  // namespace catena::app
