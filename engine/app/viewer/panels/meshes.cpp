// Meshes: colour, and their plain keys.
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/panels/look_parts.h"
#include "engine/scene/hidden.h"

namespace catena::app {

namespace {

void draw_meshes(PanelContext& context) {
  Edits& edits = context.edits;
  const scene::Scene& scene = context.scene.scene();
  scene.world.each<scene::SurfaceMesh>([&](scene::Entity e, const scene::SurfaceMesh& surface) {
    if (!begin_item(edits, surface.where, !is_hidden(scene.world, e), "mesh", name_of(scene, surface.mesh))) return;
    if (surface.color_by)
      edit_color_scale(edits, surface.where, *surface.color_by);
    else
      edit_color(edits, "colour", surface.color, pointer_of(surface.where) + "/color");
    edit_plain_keys(edits, "meshes", surface.where, {"drawn"});
    end_item();
  });
}

}  // namespace

Panel meshes_panel() { return {"Meshes", false, draw_meshes, has_any<scene::SurfaceMesh>}; }

}  // namespace catena::app
