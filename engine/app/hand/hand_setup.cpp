#include "engine/app/hand/hand_setup.h"

#include <algorithm>

namespace catena::app {

void fit_workspace(scene::Scene& scene, const Bounds& bounds, double reach_m, const Vec3& centre_m) {
  if (!scene.coupling.ramp_s) scene.coupling.ramp_s = 0.02;
  if (scene.workspace.given) {
    scene.workspace.origin -= scene.workspace.rotation * centre_m / scene.workspace.metres_per_unit;
    return;
  }
  if (bounds.empty()) return;
  const double edge = bounds.longest_edge();
  if (!(edge > 0)) return;
  scene.workspace.metres_per_unit = reach_m / edge;
  scene.workspace.origin = bounds.centre() - scene.workspace.rotation * centre_m * (edge / reach_m);
}

Vec3 first_probe(const scene::Scene& scene, const Bounds& bounds) {
  if (scene.cursor && scene.world.has<scene::Cursor>(scene.cursor)) {
    const scene::Cursor& cursor = scene.world.get<scene::Cursor>(scene.cursor);
    if (cursor.visible && is_finite(cursor.probe)) return cursor.probe;
  }
  std::optional<Vec3> seed;
  scene.world.each<scene::Link>([&](scene::Entity, const scene::Link& link) {
    if (seed || link.node.find("seed") == nullptr) return;
    if (const auto v = json::require_vec3(link.node, "seed")) seed = *v;
  });
  if (seed) return *seed;
  return bounds.empty() ? Vec3(0.0) : bounds.centre();
}

Vec3 device_from_world(const scene::Workspace& workspace, const Vec3& world) {
  return ((world - workspace.origin) * workspace.rotation) * workspace.metres_per_unit;  // v * R = R^T v
}

}  // namespace catena::app
