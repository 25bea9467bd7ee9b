/// Items of the scene by their components, for panels: where they stand in the text, what belongs together. Pure, frame thread.
#pragma once
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace catena::app {

std::string name_of(const scene::Scene& scene, scene::Entity entity);
std::vector<std::string> field_names(const scene::Scene& scene);

/// Pointers to the levels of the chain's isosurface links that hold the hand on this very surface: the same field, the same level.
std::vector<std::string> felt_levels(const scene::Scene& scene, const scene::Isosurface& surface);

}  // namespace catena::app
