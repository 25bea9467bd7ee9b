// SPDX-License-Identifier: MIT
// Panel of the isosurfaces: level on the field's histogram, color, opacity. A link on a surface follows the surface's level.
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/panels/color_widgets.h"
#include "engine/field/field_display_range.h"
#include "engine/scene/visibility.h"

namespace catena::app {

namespace {

void draw_level(PanelContext& context, Edits& edits, const scene::Isosurface& surface) {
  const json::Node* stated = surface.where.find("level");
  if (stated == nullptr || stated->kind != json::Kind::number) {
    ImGui::TextDisabled("level %.6g, follows a widget", surface.level);
    return;
  }
  scene::Scene& scene = context.scene.scene();
  const scene::FieldSource& source = scene.entities.get<scene::FieldSource>(surface.field);
  const field::AnyField& field = source.rendered.get() != nullptr ? source.rendered : source.loaded;
  double level = surface.level;
  bool moved = false;
  if (field.scalar) {
    const DisplayRange range = field::display_range(*field.scalar);
    moved = histogram_slider(context, "##level", context.state.appearance.histograms.find_or_request(scene, surface.field), range.lo,
                             range.hi, surface.color, level);
  }
  moved = input_number("level", level, "value of the field on the surface; Enter applies") || moved;
  const std::vector<std::string> link_levels = find_link_levels(scene, entity_name(scene, surface.field), surface.level);
  if (!link_levels.empty()) {
    ImGui::SameLine();
    ImGui::TextDisabled("felt");
    show_short_tooltip("a link of the chain lies on this surface: a change of the level moves the link");
  }
  if (!moved) return;
  edits.drag(make_level_edits(scene, surface, level), "isolevel");
}

void draw_isosurfaces(PanelContext& context) {
  Edits& edits = context.edits;
  const scene::Scene& scene = context.scene.scene();
  scene.entities.each<scene::Isosurface>([&](scene::Entity e, const scene::Isosurface& surface) {
    if (!begin_item(edits, surface.where, !is_hidden(scene.entities, e), "isosurface", entity_name(scene, surface.field))) return;
    draw_level(context, edits, surface);
    edit_colors(edits, scene, surface.where, surface.color, surface.color_by, {}, false);
    edit_simple_keys(edits, "isosurfaces", surface.where);
    end_item();
  });
}

}  // namespace

Panel isosurfaces_panel() { return {"Isosurfaces", true, draw_isosurfaces, has_any<scene::Isosurface>}; }

}  // namespace catena::app
