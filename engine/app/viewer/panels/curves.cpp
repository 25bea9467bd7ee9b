// SPDX-License-Identifier: MIT
// Panels of points from tables and of curves from files: one color, colors by direction or by value, and the simple keys.
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/panels/color_widgets.h"
#include "engine/scene/visibility.h"

namespace catena::app {

namespace {

void draw_curves(PanelContext& context) {
  Edits& edits = context.edits;
  const scene::Scene& scene = context.scene.scene();
  scene.entities.each<scene::CurvesSource>([&](scene::Entity e, const scene::CurvesSource& curves) {
    if (!begin_item(edits, curves.where, !is_hidden(scene.entities, e), "curves", entity_name(scene, e))) return;
    const std::string pointer = item_pointer(curves.where) + "/color";
    bool directions = !curves.color;
    if (curves.color_by) {
      edit_color_scale(edits, scene, curves.where, *curves.color_by);
    } else if (ImGui::Checkbox("colour by direction", &directions)) {
      directions ? edits.remove(pointer, "colour") : edits.set(pointer, scene::to_json(Color{1.0f, 0.3f, 0.2f}), "colour");
    } else if (curves.color) {
      edit_color(edits, "colour", *curves.color, pointer);
    }
    edit_simple_keys(edits, "curves", curves.where, {});
    end_item();
  });
}

void draw_points(PanelContext& context) {
  Edits& edits = context.edits;
  const scene::Scene& scene = context.scene.scene();
  scene.entities.each<scene::PointsSource>([&](scene::Entity e, const scene::PointsSource& points) {
    if (!begin_item(edits, points.where, !is_hidden(scene.entities, e), "points", entity_name(scene, e))) return;
    if (points.color_by)
      edit_color_scale(edits, scene, points.where, *points.color_by);
    else
      edit_color(edits, "colour", points.color, item_pointer(points.where) + "/color");
    edit_simple_keys(edits, "points", points.where, {});
    end_item();
  });
}

}  // namespace

Panel points_panel() { return {"Points", false, draw_points, has_any<scene::PointsSource>}; }
Panel curves_panel() { return {"Curves", false, draw_curves, has_any<scene::CurvesSource>}; }

}  // namespace catena::app
