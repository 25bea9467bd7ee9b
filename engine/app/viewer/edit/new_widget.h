/// These functions make a widget to begin with, as JSON text for "/widgets/-": it stands in the middle of all that is there and has a
/// quarter of its size. Frame thread.
#pragma once
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "render/frame/camera.h"

namespace catena::app {

/// "cutting_plane", "seed", ...
std::vector<std::string> widget_types();
/// An error where the scene has no field that an isolevel could stand on.
Result<std::string> new_widget(const scene::Scene& scene, const std::string& type, const Bounds& bounds);

}  // namespace catena::app
