/// The files that a scene's text names, and the text of the same scene in another folder. Inside this room only.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/scene.h"

namespace catena::scene {

/// The files of fields, meshes and colours, the device's firmware, and those of the overrides; as the scene would open them.
Result<std::vector<std::string>> referenced_files(std::string_view text, const std::string& path,
                                                  const std::vector<FieldOverride>& overrides);

std::vector<std::string> referenced_files(const json::Node& root, const std::string& path, const std::vector<FieldOverride>& overrides);

/// The text for a file at `to` that says what the text of the file at `from` with these overrides says. Nothing changes where both lie in
/// one folder and there are no overrides.
Result<std::string> relocate_text(std::string_view text, const std::string& from, const std::string& to,
                                  const std::vector<FieldOverride>& overrides);

}  // namespace catena::scene
