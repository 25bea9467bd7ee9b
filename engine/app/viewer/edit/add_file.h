/// This file makes a data file join an open scene: what the file's own scene would hold (a field and a volume or lines, or a mesh) becomes
/// edits of the open one's text. Pure, any thread.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/document.h"

namespace catena::app {

struct AddedFile {
  std::vector<scene::Document::Edit> edits;
  /// Names in the file's own scene, and in the open one, where they differ if they were taken.
  std::vector<std::pair<std::string, std::string>> names;
};

/// `added_path` is where the text of `added` stands: its relative names start there; they are stated relative to the open scene's folder
/// if they lie within, else absolute.
Result<AddedFile> edits_to_add(const std::string& open_text, const std::string& open_path, const std::string& added_text,
                               const std::string& added_path);

}  // namespace catena::app
