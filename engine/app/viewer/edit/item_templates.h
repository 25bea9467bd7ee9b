// SPDX-License-Identifier: MIT
/// Templates of new items: "show this field as ..", as JSON text with defaults that show something. Pure, any thread.
#pragma once
#include <string>
#include <vector>

#include "engine/scene/document.h"
#include "engine/scene/scene.h"
#include "render/frame/camera.h"

namespace catena::app {

/// The kinds of items that show a field.
enum class ShowAs { volume, isosurface, slice, streamlines, glyphs };

/// Returns "volume" and so on, for the undo label.
const char* to_string(ShowAs as);
/// Returns whether a field can be shown that way: a scalar field as volume, isosurface and slice; a vector field as slice (its magnitude),
/// streamlines and glyphs.
bool can_show(const field::AnyField& field, ShowAs as);

/// Returns the edits that add the item. The isosurface gets the level of a link that lies on the field, or else the middle between the 2nd
/// and the 98th percentile of `sorted` (if empty: of the field's range); the slice is across z through the center of the domain; the seeds
/// are in a ball around the center; the glyphs are on the first slice there is, or else in the domain. `values`: the field as rendered. A
/// label map gets its labels' colors; its isosurface is that of a field around all labels, which is added if there is none.
std::vector<scene::Document::Edit> make_item_edits(const scene::Scene& scene, scene::Entity field, const field::AnyField& values, ShowAs as,
                                                   const std::vector<float>& sorted);

/// Templates of widgets, in the center of the scene's bounds, a quarter of their size. Frame thread.

/// Returns the types: "cutting_plane", "seed", ...
std::vector<std::string> list_widget_types();
/// Returns the widget as JSON text for "/widgets/-". The normal of a cutting plane is the world axis nearest to `to_camera`. An Error if
/// it needs a field for its isolevel and the scene has none.
Result<std::string> make_widget_json(const scene::Scene& scene, const std::string& type, const Bounds& bounds, const Vec3& to_camera);
/// Returns the edits that add the widget. Cutting planes and boxes clip, as far as the scene can have more clip planes: a plane removes the
/// side to which its normal points, a box what is outside.
Result<std::vector<scene::Document::Edit>> make_add_widget_edits(const scene::Scene& scene, const std::string& type, const Bounds& bounds,
                                                                 const Vec3& to_camera);
/// Returns the item of "clip" for the widget, as JSON text; empty if its kind does not clip, or if there would be too many clip planes.
std::string make_clip_json(const scene::Scene& scene, const std::string& name, widget::Kind kind);

}  // namespace catena::app
