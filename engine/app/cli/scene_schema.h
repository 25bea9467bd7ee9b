/// Everything that a scene file may say, put together from the rooms that read it: the scene's parts, the constraints, the devices.
#pragma once
#include <string>
#include <vector>

#include "engine/schema/key.h"

namespace catena::app {

/// In the order of docs/scene.md.
std::vector<schema::Section> scene_file_components();
/// The JSON Schema of a scene file: `catena info --schema`.
std::string scene_json_schema();

}  // namespace catena::app
