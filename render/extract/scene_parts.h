/// Private to this room: what every part of the extraction asks of the scene.
#pragma once
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// "?" where it has none.
inline std::string name_of(const scene::Scene& scene, scene::Entity entity) {
  return scene.world.has<scene::Name>(entity) ? scene.world.get<scene::Name>(entity).value : std::string("?");
}

/// In order of insertion; a copy, so that components may be added meanwhile.
template <class T>
std::vector<scene::Entity> owners_of(const scene::World& world) {
  std::vector<scene::Entity> owners;
  world.each<T>([&](scene::Entity e, const T&) { owners.push_back(e); });
  return owners;
}

}  // namespace catena::render
