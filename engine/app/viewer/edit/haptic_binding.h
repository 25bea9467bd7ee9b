/// "Feel": the link of the chain that lies on a thing that is drawn, so that what is felt is what is seen.
///   isosurface    the same field and level (or the widget that states it); free on the eye's side
///                 of several labels (engine/scene/labels.h), the one that was pointed at: its surface, as a field that is added
///   volume        of a label map, the same of its label; else the isosurface at the value of the place that was pointed at
///   streamlines   the line through the place nearest to the one that was pointed at: its own seed, or the widget that holds it
///   curves        all its lines: the hand takes hold of the one that it comes near, and leaves it where it pulls away
///   points        the same of the points
///   slice         its plane
///   mesh          the mesh; free outside
/// Which type of link that is, its registry says (ConstraintType::feels). The link follows the thing: what changes the one in the window
/// changes the other in the same step (scene_items.h). Frame thread.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "engine/app/viewer/edit/scene_items.h"
#include "haptics/constraints/registry.h"

namespace catena::app {

/// The type of link that lies on items of this part of the scene ("isosurfaces"); nullptr: they cannot be felt.
const haptics::ConstraintType* find_constraint_type(std::string_view part);
bool can_bind_haptics(std::string_view part);

struct HapticBinding {
  std::string link_json;    ///< JSON text, for "/chain/-"
  std::string description;  ///< "isosurface brain at 45"
  /// A field that the link names and the scene does not have yet: pointer and JSON text.
  std::optional<std::pair<std::string, std::string>> new_field{};
  bool is_label = false;  ///< one label of a map: another thing than the others
};

/// `item`: where it stands in the scene, "isosurfaces[0]" (json::Node::label). `at`: the place of it that was pointed at, where one was;
/// a volume needs it. `eye`: where it is seen from. `length`: of all that is there. An error says why it cannot be felt.
Result<HapticBinding> make_haptic_binding(scene::Scene& scene, const std::string& item, const std::optional<Vec3>& at, const Vec3& eye,
                                          double length);

/// The name of a link that lies on that very thing already; empty: none does.
std::string find_bound_link(const scene::Scene& scene, const HapticBinding& thing);

/// The edits that make the link. One that lies on the same item already (removal.h), at another level or on another line of it, is taken
/// over: it keeps its name and what it has beside.
TextEdits make_binding_edits(scene::Scene& scene, const std::string& item, const HapticBinding& thing);

/// Pointers to the places and normals of all links that lie on the slice's plane, to be changed along with it: (pointer to the link).
std::vector<std::string> find_coplanar_links(const scene::Scene& scene, const Vec3& point, const Vec3& normal);

}  // namespace catena::app
