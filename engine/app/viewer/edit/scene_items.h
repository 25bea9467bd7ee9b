/// These functions say where things stand in the scene's text (RFC 6901), and what their text is. Pure, any thread.
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

/// "/volumes/2" for the item that was read from there (its label is "volumes[2]"); empty where it is no item of a list.
std::string item_pointer(const json::Node& item);

/// Items of the scene by their components, for panels: where they stand in the text, what belongs together. Pure, frame thread.
std::string entity_name(const scene::Scene& scene, scene::Entity entity);
std::vector<std::string> field_names(const scene::Scene& scene);

/// A copy of the component that was read from `item` ("slices[1]"): loading a field may move the others.
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

/// Pointers to the levels of all links of the chain that lie on the surface `field` = `level`, of whatever type (isosurface, friction,
/// texture): the same field, the same number.
std::vector<std::string> find_link_levels(const scene::Scene& scene, const std::string& field, double level);
/// The same of the isosurfaces that are drawn or hidden.
std::vector<std::string> find_isosurface_levels(const scene::Scene& scene, const std::string& field, double level);
/// What gives a drawn isosurface another level: the links that lie on it go along.
TextEdits make_level_edits(const scene::Scene& scene, const scene::Isosurface& surface, double level);

/// The level of the field's surface that is drawn, as JSON text: a number, or {"widget": NAME} where it follows a widget. Of several, the
/// one that is nearest to `value`. Empty: none is drawn.
std::string visible_surface_level(const scene::Scene& scene, const std::string& field, double value);
/// The same of the links that lie on a level of the field: of several, the first one's.
std::string first_link_level(const scene::Scene& scene, const std::string& field);
/// The field of the first surface that is drawn; empty: none is.
std::string visible_surface_field(const scene::Scene& scene);

/// When the hand lets go of a widget, where it stands becomes an edit of the scene's text: one step of undo. Frame thread.
class WidgetEdits {
 public:
  struct FinishedMove {
    std::string undo_label;  ///< "move cut"
    std::vector<scene::Document::Edit> edits;
  };
  /// What ended since the last call.
  std::vector<FinishedMove> take_finished(const scene::Scene& scene);

 private:
  std::map<std::string, bool> grabbed_;  ///< by the widget's place in the text
};

}  // namespace catena::app
