// SPDX-License-Identifier: MIT
/// Addition of the items of one scene to another. Any thread.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/document.h"

namespace catena::scene {

/// The items of a scene, as edits of another scene's text.
struct MergedScene {
  std::vector<Document::Edit> edits;
  /// Names of the fields in the added scene and in the open one, which differ if the name was taken.
  std::vector<std::pair<std::string, std::string>> fields;
};

/// Returns the edits that add everything that `added` shows: its fields and the items of all lists, except lights, chain, modes and clip
/// planes. Names that are taken are replaced in all references, and references by index are moved. `added_path`: path of the text `added`,
/// to which its relative file names refer; they are rewritten for `open_path`. An Error if a text cannot be parsed.
Result<MergedScene> merge_scene(const std::string& open, const std::string& open_path, const std::string& added,
                                const std::string& added_path);

}  // namespace catena::scene
