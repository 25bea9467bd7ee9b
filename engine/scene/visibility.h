// SPDX-License-Identifier: MIT
/// "visible": false for volumes, isosurfaces, slices, streamlines, glyphs, curves, points and meshes: the object is part of the scene but
/// not rendered. Its index in lists, objects bound to it, and haptics are unaffected. Frame thread.
#pragma once
#include "engine/scene/scene.h"

namespace catena::scene {

/// Component of an object that is not rendered.
struct Hidden {};

/// Returns whether the entity is not rendered.
inline bool is_hidden(const EntityStore& world, Entity e) { return world.has<Hidden>(e); }

/// Reads the key "visible" of the item from which `e` was read.
inline Outcome read_visible(Scene& scene, Entity e, const json::Node& item) {
  CATENA_TRY(const bool visible, json::get_boolean(item, "visible", true));
  if (!visible) scene.entities.emplace<Hidden>(e);
  return Done{};
}

}  // namespace catena::scene
