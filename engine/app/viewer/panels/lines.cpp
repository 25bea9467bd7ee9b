// Streamlines: one colour or the colours of values, radius.
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/panels/look_parts.h"
#include "engine/scene/hidden.h"

namespace catena::app {

namespace {

void draw_lines(PanelContext& context) {
  Edits& edits = context.edits;
  const scene::Scene& scene = context.scene.scene();
  scene.world.each<scene::StreamlineSet>([&](scene::Entity e, const scene::StreamlineSet& set) {
    if (!begin_item(edits, set.where, !is_hidden(scene.world, e), "streamlines", name_of(scene, set.field))) return;
    edit_colors(edits, scene, set.where, set.color, set.color_by, {"speed", "arc_length"});
    const scene::FieldSource& source = scene.world.get<scene::FieldSource>(set.field);
    const double length = source.loaded.get() != nullptr ? source.loaded.get()->length() : 1;
    edit_fitted(edits, "radius", set.where, set.radius, 0.05 * length, "of the tubes, world units; at the left end: fitted to the domain");
    edit_plain_keys(edits, "streamlines", set.where, {"tolerance"});
    end_item();
  });
}

}  // namespace

Panel lines_panel() { return {"Lines", false, draw_lines, has_any<scene::StreamlineSet>}; }

}  // namespace catena::app
