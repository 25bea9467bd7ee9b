// SPDX-License-Identifier: MIT
/// The schema of a scene file, assembled from the modules that read its parts: the scene, the constraints, the devices.
#pragma once
#include <string>
#include <vector>

#include "engine/schema/key.h"

namespace catena::app {

/// The sections of a scene file, in the order of docs/reference/scene.md.
std::vector<schema::Section> scene_file_components();
/// The JSON Schema of a scene file: output of `catena info --schema`.
std::string scene_json_schema();

}  // namespace catena::app
