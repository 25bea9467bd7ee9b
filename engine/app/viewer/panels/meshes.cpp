// SPDX-License-Identifier: MIT
// Panel of the meshes: color and simple keys.
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/panels/color_widgets.h"
#include "engine/scene/visibility.h"

namespace catena::app {

namespace {

void draw_meshes(PanelContext& context) {
  Edits& edits = context.edits;
  const scene::Scene& scene = context.scene.scene();
  scene.entities.each<scene::SurfaceMesh>([&](scene::Entity e, const scene::SurfaceMesh& surface) {
    if (!begin_item(edits, surface.where, !is_hidden(scene.entities, e), "mesh", entity_name(scene, surface.mesh))) return;
    if (surface.color_by)
      edit_color_scale(edits, scene, surface.where, *surface.color_by);
    else
      edit_color(edits, "colour", surface.color, item_pointer(surface.where) + "/color");
    edit_simple_keys(edits, "meshes", surface.where);
    end_item();
  });
}

}  // namespace

Panel meshes_panel() { return {"Meshes", false, draw_meshes, has_any<scene::SurfaceMesh>}; }

}  // namespace catena::app
