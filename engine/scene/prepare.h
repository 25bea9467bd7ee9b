/// Makes ready what a scene describes: drives what follows widgets, loads the fields and meshes that something visible names, traces its
/// lines. Who draws or feels the scene afterwards only reads it. Frame thread.
#pragma once
#include "engine/geometry/bounds.h"
#include "engine/scene/scene.h"

namespace catena::scene {

/// Nothing is made twice: a scene in which nothing has changed costs nothing. Errors carry the scene file's name and line.
Outcome prepare(Scene& scene);

/// The world box of all that is loaded, drawn or felt, and of the lines. Empty before prepare.
Bounds prepared_bounds(const Scene& scene);

}  // namespace catena::scene
