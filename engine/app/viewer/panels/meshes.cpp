// Meshes: colour, opacity, edges.
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
    const std::string pointer = pointer_of(surface.where);
    edit_share(edits, "opacity", surface.opacity, pointer + "/opacity");
    if (surface.color_by)
      edit_color_scale(edits, surface.where, surface.color_by->colors, surface.color_by->named, "viridis");
    else
      edit_color(edits, "colour", surface.color, pointer + "/color");
    ImGui::SameLine();
    edit_boolean(edits, "edges", surface.edges, pointer + "/edges");
    ImGui::SameLine();
    bool smooth = surface.smooth;
    if (ImGui::Checkbox("smooth", &smooth)) edits.set(pointer + "/shading", smooth ? "\"smooth\"" : "\"flat\"", "shading");
    short_tip("shading only: the felt mesh is flat");
    end_item();
  });
}

}  // namespace

Panel meshes_panel() { return {"Meshes", false, draw_meshes, has_any<scene::SurfaceMesh>}; }

}  // namespace catena::app
