// SPDX-License-Identifier: MIT
/// "visible": false for drawables (drawable.h): the object is part of the scene but not rendered. Its index in lists, objects bound to it,
/// and haptics are unaffected. Frame thread.
#pragma once
#include <vector>

#include "engine/scene/scene.h"

namespace catena::scene {

/// Component of an object that is not rendered.
struct Hidden {};

/// Returns whether the entity is not rendered.
inline bool is_hidden(const EntityStore& world, Entity e) { return world.has<Hidden>(e); }

/// Returns the visible entities that have the component T; a copy, so that components may be added meanwhile.
template <class T>
std::vector<Entity> visible_entities(const EntityStore& world) {
  std::vector<Entity> all;
  world.each<T>([&](Entity e, const T&) {
    if (!is_hidden(world, e)) all.push_back(e);
  });
  return all;
}

/// Reads the key "visible" of the item from which `e` was read.
inline Outcome read_visible(Scene& scene, Entity e, const json::Node& item) {
  CATENA_TRY(const bool visible, json::get_boolean(item, "visible", true));
  if (!visible) scene.entities.emplace<Hidden>(e);
  return Done{};
}

}  // namespace catena::scene
