// SPDX-License-Identifier: MIT
/// Templates of new items: "show this field as ..", as JSON text with defaults that show something. Pure, any thread.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/document.h"
#include "engine/scene/scene.h"
#include "render/frame/camera.h"

namespace catena::app {

/// The kinds of items that show a field.
enum class ShowAs { volume, isosurface, slice, streamlines, glyphs };

/// Returns where the new item is added: "/volumes/-" and so on.
std::string new_item_pointer(ShowAs as);
/// Returns "volume" and so on, for the undo label.
const char* to_string(ShowAs as);
/// Returns whether a field can be shown that way: a scalar field as volume, isosurface and slice; a vector field as slice (its magnitude),
/// streamlines and glyphs.
bool can_show(const field::AnyField& field, ShowAs as);

/// Returns the item as JSON text. The isosurface gets the level of a link that lies on the field, or else the middle between the 2nd and
/// the 98th percentile of `sorted` (if empty: of the field's range); the slice is across z through the center of the domain; the seeds are
/// in a ball around the center; the glyphs are on the first slice there is, or else in the domain. `values`: the field as rendered.
std::string make_item_json(const scene::Scene& scene, scene::Entity field, const field::AnyField& values, ShowAs as,
                           const std::vector<float>& sorted);

/// Templates of widgets, as JSON text for "/widgets/-": in the center of the scene's bounds, a quarter of their size. Frame thread.

/// Returns the types: "cutting_plane", "seed", ...
std::vector<std::string> list_widget_types();
/// Returns the widget. An Error if it needs a field for its isolevel and the scene has none.
Result<std::string> make_widget_json(const scene::Scene& scene, const std::string& type, const Bounds& bounds);

/// A data file merged into an open scene: the content of the file's own scene (a field and a volume or lines, or a mesh) as edits of the
/// open scene's text. Pure, any thread.
struct MergedFile {
  std::vector<scene::Document::Edit> edits;
  /// Names in the file's own scene and their names in the open one, which differ if the name was taken.
  std::vector<std::pair<std::string, std::string>> renames;
};

/// Returns the edits. `added_path`: location of the text `added`, to which its relative file names refer; they become relative to the open
/// scene's folder if they are inside it, else absolute. An Error if a text cannot be parsed.
Result<MergedFile> make_merge_edits(const std::string& open_text, const std::string& open_path, const std::string& added_text,
                                    const std::string& added_path);

}  // namespace catena::app
