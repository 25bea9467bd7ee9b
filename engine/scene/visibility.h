/// "visible": false of volumes, isosurfaces, slices, streamlines, glyphs and meshes: the thing is of the scene, the eye leaves it out. Its
/// numbers in lists, what follows it and what the hand feels stay as they are. Frame thread.
#pragma once
#include "engine/scene/scene.h"

namespace catena::scene {

/// Beside the component of what is hidden.
struct Hidden {};

inline bool is_hidden(const EntityStore& world, Entity e) { return world.has<Hidden>(e); }

/// Reads the key of the item that `e` was read from.
inline Outcome read_visible(Scene& scene, Entity e, const json::Node& item) {
  CATENA_TRY(const bool visible, json::get_boolean(item, "visible", true));
  if (!visible) scene.entities.emplace<Hidden>(e);
  return Done{};
}

}  // namespace catena::scene
