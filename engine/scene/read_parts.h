/// The readers of the scene file's parts, one function a top-level key. Inside this room only. Each checks its keys and values
/// completely and answers "FILE:LINE: what; what was expected".
#pragma once
#include <string>

#include "engine/scene/scene.h"

namespace catena::scene {

/// [a-z][a-z0-9_]*, and for links none of the words that the tick CSV uses itself.
bool is_name(std::string_view text);

/// Relative paths start at the scene file's folder.
std::string resolved_path(const std::string& scene_path, const std::string& file);

Outcome read_fields(Scene& scene, const json::Node& root, const std::vector<FieldOverride>& overrides);
/// The entity of the field that member `key` of `object` names; an error lists the known ones.
Result<Entity> read_field_name(const Scene& scene, const json::Node& object, std::string_view key = "field");

/// Three numbers 0..1 as a colour.
Result<Rgb> as_color(const Vec3& c, const json::Node& node, std::string_view what);
/// "opacity": 0..1.
Result<double> read_opacity(const json::Node& object, double fallback);
/// Member `key` as [r, g, b], 0..1.
Result<Rgb> read_color(const json::Node& object, std::string_view key, const Rgb& fallback);
/// Rows [value, r, g, b], values rising.
Result<std::vector<TransferFunction::ColorPoint>> read_color_table(const json::Node& node, std::string_view what);

/// "color_by": {"field", "color", "range", "transfer"} of a volume or an isosurface.
Result<std::optional<FieldColors>> read_field_colors(const Scene& scene, const json::Node& object);
/// "projection" of a volume, and whether it goes with what else the volume states.
Outcome read_projection(Volume& volume, const json::Node& object);

/// "widgets": the things that the hand takes hold of.
Outcome read_widgets(Scene& scene, const json::Node& node);
/// The widget that member "widget" of `object` names, one of `kinds`; `wanted` says them in words ("a cutting plane or a box").
Result<Entity> read_widget_name(const Scene& scene, const json::Node& object, std::initializer_list<widget::Kind> kinds,
                                std::string_view wanted);

Outcome read_chain(Scene& scene, const json::Node& node);
Outcome read_modes(Scene& scene, const json::Node& node);
Outcome read_coupling(Scene& scene, const json::Node& node);
Outcome read_workspace(Scene& scene, const json::Node& node);
Outcome read_device(Scene& scene, const json::Node& node);

Outcome read_volumes(Scene& scene, const json::Node& node);
Outcome read_isosurfaces(Scene& scene, const json::Node& node);
Outcome read_meshes(Scene& scene, const json::Node& node);
Outcome read_slices(Scene& scene, const json::Node& node);
Outcome read_streamlines(Scene& scene, const json::Node& node);
Outcome read_indicator(Scene& scene, const json::Node& node);
Outcome read_cursor(Scene& scene, const json::Node& node);

Outcome read_scalar_bars(Scene& scene, const json::Node& node);
Outcome read_labels(Scene& scene, const json::Node& node);
Outcome read_title(Scene& scene, const json::Node& node);
Outcome read_orientation_marker(Scene& scene, const json::Node& node);
Outcome read_status(Scene& scene, const json::Node& node);
Outcome read_overlay(Scene& scene, const json::Node& node);

Outcome read_camera(Scene& scene, const json::Node& node);
Outcome read_stereo(Scene& scene, const json::Node& node);
/// "clip": planes and boxes; "clip": false in an item, as `clipped`.
Outcome read_clip(Scene& scene, const json::Node& node);
/// "jitter": true or false.
Outcome read_jitter(Scene& scene, const json::Node& node);
Outcome read_bounding_box(Scene& scene, const json::Node& node);
Outcome read_axes(Scene& scene, const json::Node& node);
Outcome read_ground(Scene& scene, const json::Node& node);
Outcome read_fog(Scene& scene, const json::Node& node);
Outcome read_lights(Scene& scene, const json::Node& node);
Outcome read_background(Scene& scene, const json::Node& node);
Outcome read_quality(Scene& scene, const json::Node& node);

}  // namespace catena::scene
