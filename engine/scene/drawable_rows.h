// SPDX-License-Identifier: MIT
/// Private to this module: the rows of the registry of drawables (drawable.h), each defined in the file of its reader.
#pragma once
#include "engine/scene/drawable.h"

namespace catena::scene {

Drawable volumes();
Drawable isosurfaces();
Drawable meshes();
Drawable slices();
Drawable streamlines();
Drawable glyphs();
Drawable curves();
Drawable points();

/// Loads the data of each visible item with the component T by `use`, and the field that colors it.
template <class T, class Use>
Outcome load_visible(Scene& scene, const Use& use) {
  for (const Entity e : visible_entities<T>(scene.entities)) CATENA_CHECK(use(e, T(scene.entities.get<T>(e))));
  return Done{};
}
/// Loads the field of "color_by" of lines, glyphs, curves or points.
inline Outcome load_color_field(Scene& scene, const std::optional<ColorBy>& by) {
  if (by && by->source == ColorBy::Source::field) CATENA_CHECK(resolve_field(scene, by->field, by->where));
  return Done{};
}

}  // namespace catena::scene
