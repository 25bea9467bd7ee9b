/// A scene that a program holds as an object, as Python's dict, and that lies in no file. Off the tick, any thread.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/scene.h"

namespace catena::scene {

/// parse_scene() of the object's JSON text; `name` stands for it. Messages name the place within the object, "NAME: /volumes/0/opacity:
/// ...", because the text has no lines that anybody could look at.
Result<Scene> parse_scene_object(std::string_view text, const std::string& name, const std::vector<FieldOverride>& overrides = {});

}  // namespace catena::scene
