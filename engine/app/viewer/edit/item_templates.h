/// These functions make what "show this field as .." adds to the scene: an item with defaults that show something, as JSON text. Pure, any
/// thread.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/document.h"
#include "engine/scene/scene.h"
#include "render/frame/camera.h"

namespace catena::app {

enum class ShowAs { volume, isosurface, slice, streamlines, glyphs };

/// Where it goes: "/volumes/-" and so on.
std::string new_item_pointer(ShowAs as);
/// "volume" and so on, for the menu of undo.
const char* to_string(ShowAs as);
/// A scalar field as a volume, an isosurface and a slice, a vector field as a slice (its magnitude), streamlines and glyphs.
bool can_show(const field::AnyField& field, ShowAs as);

/// The isosurface lies where a link of the chain lies on the field, or else half way between the 2nd and the 98th percentile of `sorted`
/// (empty: of the field's range), the slice across z through the middle of the domain, the seeds in a ball around it; the
/// glyphs stand on the first slice that is there, or else in the domain. `values`: of the
/// field as it is drawn.
std::string make_item_json(const scene::Scene& scene, scene::Entity field, const field::AnyField& values, ShowAs as,
                           const std::vector<float>& sorted);

/// These functions make a widget to begin with, as JSON text for "/widgets/-": it stands in the middle of all that is there and has a
/// quarter of its size. Frame thread.

/// "cutting_plane", "seed", ...
std::vector<std::string> list_widget_types();
/// An error where the scene has no field that an isolevel could stand on.
Result<std::string> make_widget_json(const scene::Scene& scene, const std::string& type, const Bounds& bounds);

/// This file makes a data file join an open scene: what the file's own scene would hold (a field and a volume or lines, or a mesh) becomes
/// edits of the open one's text. Pure, any thread.
struct MergedFile {
  std::vector<scene::Document::Edit> edits;
  /// Names in the file's own scene, and in the open one, where they differ if they were taken.
  std::vector<std::pair<std::string, std::string>> renames;
};

/// `added_path` is where the text of `added` stands: its relative names start there; they are stated relative to the open scene's folder
/// if they lie within, else absolute.
Result<MergedFile> make_merge_edits(const std::string& open_text, const std::string& open_path, const std::string& added_text,
                                    const std::string& added_path);

}  // namespace catena::app
