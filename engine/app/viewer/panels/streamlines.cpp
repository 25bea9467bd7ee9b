// SPDX-License-Identifier: MIT
// Panel of the streamlines: one color or colors by value, radius.
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/panels/color_widgets.h"
#include "engine/scene/visibility.h"

namespace catena::app {

namespace {

void draw_lines(PanelContext& context) {
  Edits& edits = context.edits;
  const scene::Scene& scene = context.scene.scene();
  scene.entities.each<scene::StreamlineSet>([&](scene::Entity e, const scene::StreamlineSet& set) {
    if (!begin_item(edits, set.where, !is_hidden(scene.entities, e), "streamlines", entity_name(scene, set.field))) return;
    edit_colors(edits, scene, set.where, set.color, set.color_by, {"speed", "arc_length"});
    const scene::FieldSource& source = scene.entities.get<scene::FieldSource>(set.field);
    const double length = source.loaded.get() != nullptr ? source.loaded.get()->domain_length() : 1;
    edit_auto_length(edits, "radius", set.where, set.radius, 0.05 * length,
                     "radius of the tubes, world units; left end: chosen from the size of the domain");
    edit_simple_keys(edits, "streamlines", set.where, {"tolerance"});
    end_item();
  });
}

}  // namespace

Panel lines_panel() { return {"Lines", false, draw_lines, has_any<scene::StreamlineSet>}; }

}  // namespace catena::app
