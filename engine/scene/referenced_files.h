// SPDX-License-Identifier: MIT
/// Files that a scene's text refers to, and the rewriting of the text for another folder. Private to this module.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/scene.h"

namespace catena::scene {

/// Returns the paths of all files that the text names, as the scene opens them (fields, meshes, colors, the device's firmware, ...), and
/// those of the overrides. Error: the text is not JSON.
Result<std::vector<std::string>> referenced_files(std::string_view text, const std::string& path,
                                                  const std::vector<FieldOverride>& overrides);

/// Returns the paths of all files that a parsed scene names, and those of the overrides.
std::vector<std::string> referenced_files(const json::Node& root, const std::string& path, const std::vector<FieldOverride>& overrides);

/// Returns the text for a file at `to` that is equivalent to the text of the file at `from` with these overrides: relative file names and
/// the overridden fields are rewritten. Unchanged if both are in the same folder and there are no overrides.
Result<std::string> relocate_text(std::string_view text, const std::string& from, const std::string& to,
                                  const std::vector<FieldOverride>& overrides);

}  // namespace catena::scene
