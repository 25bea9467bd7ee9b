#include "engine/app/viewer/shell/step_player.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "engine/base/clock.h"
#include "engine/field/kept.h"
#include "engine/scene/steps.h"

namespace catena::app {

Outcome StepPlayer::show(SceneHost& host, int step) {
  scene::Scene& scene = host.scene();
  const int count = scene::step_count(scene), wanted = (step % count + count) % count;
  if (count < 2 || wanted == scene.time.step) return Done{};
  for (const field::LoadRequest& request : scene::requests_at(scene, wanted))
    if (const auto loaded = field::load_kept(request); !loaded) {
      plays = false;
      return loaded.error();
    }
  last_ns_ = now_ns();
  if (scene::set_step(scene, wanted)) host.touch();
  return Done{};
}

Outcome StepPlayer::run(SceneHost& host) {
  const scene::Scene& scene = std::as_const(host).scene();
  const int count = plays ? scene::step_count(scene) : 1;
  if (count < 2) return Done{};
  const int next = (scene.time.step + 1) % count;
  std::vector<field::LoadRequest> requests = scene::requests_at(scene, next);
  const bool ready = std::all_of(requests.begin(), requests.end(), field::is_kept);
  constexpr double kLongestWaitS = 30;  // then it is loaded here, which says what is wrong
  const double since_s = 1e-3 * ms_since(last_ns_), period_s = 1 / scene.time.per_second;
  if (since_s >= period_s && (ready || since_s >= period_s + kLongestWaitS)) return show(host, next);
  if (ahead_ == next) return Done{};
  ahead_ = next;
  constexpr int kAhead = 3;
  for (int k = 2; k <= kAhead; ++k) {
    std::vector<field::LoadRequest> more = scene::requests_at(scene, (scene.time.step + k) % count);
    std::move(more.begin(), more.end(), std::back_inserter(requests));
  }
  field::load_ahead(std::move(requests));
  return Done{};
}

}  // namespace catena::app
