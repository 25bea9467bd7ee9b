// SPDX-License-Identifier: MIT
/// Haptic binding (command "Feel"): creates the link of the chain that lies on a visible item, so that haptics and image agree.
///   isosurface    the same field and level (or the widget that states it); free on the side of the camera
///                 of a surface of several labels (engine/scene/labels.h): the picked label's surface, as an added field
///   volume        of a label map: the surface of the picked label; else the isosurface at the value of the picked point
///   streamlines   the line that passes closest to the picked point: its own seed, or the widget that holds it
///   curves        all of its lines: the probe snaps to a line that it comes near and is released when it pulls away
///   points        the same for points
///   slice         its plane
///   mesh          the mesh; free on the side of the camera, or outside if no point was picked
/// The registry states the type of link (ConstraintType::scene_section). The link follows the item: an edit of one changes the other in the
/// same step (scene_items.h). Frame thread.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "engine/app/viewer/edit/scene_items.h"
#include "haptics/constraints/registry.h"

namespace catena::app {

/// Returns the type of link for items of a section of the scene ("isosurfaces"); nullptr: they cannot be bound.
const haptics::ConstraintType* find_constraint_type(std::string_view part);
/// Returns whether items of that section can be bound.
bool can_bind_haptics(std::string_view part);

/// A link for an item, not added to the scene yet.
struct HapticBinding {
  std::string link_json;    ///< JSON text, to be added at "/chain/-".
  std::string description;  ///< Text for messages: "isosurface brain at 45".
  /// A field that the link refers to and the scene does not have yet: pointer and JSON text.
  std::optional<std::pair<std::string, std::string>> new_field{};
  bool is_label = false;  ///< The link is for one label of a label map; each label is an item of its own.
};

/// Returns the link for an item. `item`: its place in the scene, "isosurfaces[0]" (json::Node::label). `at`: the picked point, if any;
/// required for a volume. `camera_position`: position of the camera. `length`: diagonal of the scene. World units. An Error states why the
/// item cannot be bound.
Result<HapticBinding> make_haptic_binding(scene::Scene& scene, const std::string& item, const std::optional<Vec3>& at,
                                          const Vec3& camera_position, double length);

/// Returns the name of an existing link with the same keys (apart from name, free, release and snap); empty if there is none.
std::string find_bound_link(const scene::Scene& scene, const HapticBinding& binding);

/// Returns the edits that add the link. A link that already lies on the same item (remove_item.h), at another level or on another line of
/// it, is modified instead: it keeps its name and its other keys.
TextEdits make_binding_edits(scene::Scene& scene, const std::string& item, const HapticBinding& binding);

/// Returns pointers to all plane links that coincide with the slice's plane, which are to be moved together with it.
std::vector<std::string> find_coplanar_links(const scene::Scene& scene, const Vec3& point, const Vec3& normal);

}  // namespace catena::app
