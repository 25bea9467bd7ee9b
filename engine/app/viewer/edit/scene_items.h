// SPDX-License-Identifier: MIT
/// Items of the scene: their JSON pointers (RFC 6901) in the scene's text, and relations between them. Pure, any thread.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/json.h"
#include "engine/scene/document.h"
#include "engine/scene/scene.h"

namespace catena::app {

using TextEdits = std::vector<scene::Document::Edit>;

/// Returns "/volumes/2" for the item read from there (its label is "volumes[2]"); empty if it is not an item of a list.
std::string item_pointer(const json::Node& item);

/// Returns the name of an entity, empty if it has none; and the names of all fields. Frame thread.
std::string entity_name(const scene::Scene& scene, scene::Entity entity);
std::vector<std::string> field_names(const scene::Scene& scene);

/// Returns a copy of the component read from `item` ("slices[1]"); a copy, because loading a field may move the components. `entity`, if
/// not null, receives its entity.
template <class T>
std::optional<T> find_item(const scene::Scene& scene, const std::string& item, scene::Entity* entity = nullptr) {
  std::optional<T> found;
  scene.entities.each<T>([&](scene::Entity e, const T& part) {
    if (found || part.where.label != item) return;
    found = part;
    if (entity != nullptr) *entity = e;
  });
  return found;
}

/// Returns pointers to the levels of all links of the chain that lie on the surface `field` = `level`, of any type (isosurface, friction,
/// texture): the same field, the same number.
std::vector<std::string> find_link_levels(const scene::Scene& scene, const std::string& field, double level);
/// Returns pointers to the levels of all isosurfaces, visible or hidden, with this field and level.
std::vector<std::string> find_isosurface_levels(const scene::Scene& scene, const std::string& field, double level);
/// Returns the edits that change the level of an isosurface, together with the links that lie on it.
TextEdits make_level_edits(const scene::Scene& scene, const scene::Isosurface& surface, double level);

/// Returns the level of the field's visible isosurface as JSON text: a number, or {"widget": NAME} if it follows a widget. Of several, the
/// one nearest to `value`. Empty: none is visible.
std::string visible_surface_level(const scene::Scene& scene, const std::string& field, double value);
/// Returns the level of the first link that lies on a level of the field, as JSON text; empty if there is none.
std::string first_link_level(const scene::Scene& scene, const std::string& field);
/// Returns the field of the first visible isosurface; empty if there is none.
std::string visible_surface_field(const scene::Scene& scene);

/// Returns the edits that give the widget another pose.
TextEdits make_pose_edits(const scene::Widget& widget, const widget::Pose& pose);

/// Converts the final position of a widget, when the user releases it, into edits of the scene's text: one undo step. Frame thread.
class WidgetEdits {
 public:
  /// A completed move of a widget.
  struct FinishedMove {
    std::string undo_label;  ///< "move cut"
    std::vector<scene::Document::Edit> edits;
  };
  /// Returns the moves completed since the last call.
  std::vector<FinishedMove> take_finished(const scene::Scene& scene);

 private:
  std::map<std::string, bool> grabbed_;  ///< Whether a widget is held; key: its JSON pointer.
};

}  // namespace catena::app
