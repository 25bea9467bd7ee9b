// SPDX-License-Identifier: MIT
/// A scene given as an object in memory, such as a Python dict, instead of a file. Off the tick, any thread.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/export.h"
#include "engine/scene/scene.h"

namespace catena::scene {

/// parse_scene() for the JSON text of the object; `name` is used in place of its path. Since the text has no lines that a user could look
/// up, errors give the position by a JSON pointer: "NAME: /volumes/0/opacity: ...".
CATENA_EXPORT Result<Scene> parse_scene_object(std::string_view text, const std::string& name,
                                               const std::vector<FieldOverride>& overrides = {});

}  // namespace catena::scene
