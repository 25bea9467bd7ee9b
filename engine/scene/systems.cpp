#include "engine/scene/systems.h"

#include <algorithm>

namespace catena::scene {

void update_cursor(Scene& scene, const exchange::HapticState& state) {
  if (!is_finite(state.probe)) return;
  Cursor& cursor = scene.world.get<Cursor>(scene.cursor);
  cursor.probe = state.probe;
  cursor.force_n = state.force_n;
  cursor.visible = true;
  const int links = std::clamp(state.link_count, 0, exchange::kMaxLinks);
  cursor.proxies.clear();
  cursor.active.clear();
  cursor.leaving.clear();
  cursor.statuses.clear();
  for (int i = 0; i < links; ++i) {
    const exchange::LinkReport& link = state.links[static_cast<std::size_t>(i)];
    cursor.proxies.push_back(link.proxy);
    cursor.active.push_back(link.active);
    cursor.statuses.push_back(link.status);
    cursor.leaving.push_back(link.left ? 1.0 : std::clamp(link.leaving, 0.0, 1.0));
  }
}

}  // namespace catena::scene
