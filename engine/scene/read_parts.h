/// The parts of the scene file, one function a top-level key: its description (engine/schema) and its reader, which checks keys and values
/// completely and answers "FILE:LINE: what; what was expected". A new part is one file and one line in scene_file.cpp. Inside this room
/// only.
#pragma once
#include <string>

#include "engine/base/text.h"
#include "engine/scene/scene.h"
#include "engine/schema/key.h"

namespace catena::scene {

struct Part {
  schema::Component description;  ///< of "chain", "modes" and "device" the keys are told by the rooms that read them
  Outcome (*read)(Scene&, const json::Node&);
};

// in the order of docs/scene.md
Part fields_part();
Part chain_part();
Part modes_part();
Part coupling_part();
Part workspace_part();
Part device_part();
Part widgets_part();
Part volumes_part();
Part isosurfaces_part();
Part slices_part();
Part meshes_part();
Part streamlines_part();
Part indicator_part();
Part clip_part();
Part camera_part();
Part lights_part();
Part stereo_part();
Part background_part();
Part quality_part();
Part jitter_part();
Part cursor_part();
Part unit_length_part();
Part bounding_box_part();
Part axes_part();
Part ground_part();
Part fog_part();
Part scalar_bars_part();
Part labels_part();
Part title_part();
Part orientation_marker_part();
Part status_part();
Part overlay_part();

/// Calls read(item) for each object of an array.
template <class Read>
Outcome each_item(const json::Node& node, Read&& read) {
  if (node.kind != json::Kind::array) return json::error_at(node, in_quotes(node.label) + " is no array; an array of objects was expected");
  for (const json::Node& item : node.items) {
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_CHECK(read(item));
  }
  return Done{};
}

/// [a-z][a-z0-9_]*
bool is_name(std::string_view text);
/// `kind` says in the message what is called so: "mesh".
Outcome check_name(const std::string& kind, const std::string& name, const json::Node& node);

/// Relative paths start at the scene file's folder.
std::string resolved_path(const std::string& scene_path, const std::string& file);

Outcome read_fields(Scene& scene, const json::Node* fields, const std::vector<FieldOverride>& overrides);
/// The entity of the field that member `key` of `object` names; an error lists the known ones.
Result<Entity> read_field_name(const Scene& scene, const json::Node& object, std::string_view key = "field");

/// Rows [value, r, g, b], values rising.
Result<std::vector<TransferFunction::ColorPoint>> read_color_table(const json::Node& node, std::string_view what);

/// The widget that member "widget" of `object` names, one of `kinds`; `wanted` says them in words ("a cutting plane or a box").
Result<Entity> read_widget_name(const Scene& scene, const json::Node& object, std::initializer_list<widget::Kind> kinds,
                                std::string_view wanted);

}  // namespace catena::scene
