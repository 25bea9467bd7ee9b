// SPDX-License-Identifier: MIT
// Panel of the widgets that the probe can move: state, pose, and creation of new ones.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "engine/app/viewer/edit/item_templates.h"
#include "engine/app/viewer/edit/remove_item.h"
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/panels/panel.h"
#include "engine/app/viewer/panels/property_widgets.h"
#include "engine/base/json_edit.h"
#include "engine/scene/to_json.h"
#include "engine/scene/widgets.h"

namespace catena::app {

namespace {

struct Row {
  scene::Entity entity;
  std::string name, pointer;
  scene::Widget widget;
};

std::vector<Row> rows_of(const scene::Scene& scene) {
  std::vector<Row> rows;
  scene.entities.each<scene::Widget>([&](scene::Entity e, const scene::Widget& widget) {
    rows.push_back({e, scene.entities.get<scene::Name>(e).value, fmt::format("/widgets/{}", rows.size()), widget});
  });
  return rows;
}

/// Draws the pose as numbers; an edit writes it to the scene text.
void draw_pose(PanelContext& context, const Row& row) {
  const widget::Pose& pose = row.widget.report.pose;
  const double speed = 0.001 * row.widget.spec.length;
  const auto place = [&](const char* key, const Vec3& value) { edit_vector(context.edits, key, row.pointer + "/" + key, value, speed); };
  switch (row.widget.spec.kind) {
    case widget::Kind::cutting_plane: {
      place("center", pose.points[0]);
      const Vec3 normal = scene::plane_normal(pose);
      // the orientation can be stated in two ways: editing one removes the other
      const auto rounded = [](double x) { return std::abs(x) < 1e-12 ? 0.0 : x; };  // no rounding errors of the rotation
      double n[3] = {rounded(normal.x), rounded(normal.y), rounded(normal.z)};
      if (ImGui::InputScalarN("normal", ImGuiDataType_Double, n, 3, nullptr, nullptr, "%.3g", ImGuiInputTextFlags_EnterReturnsTrue))
        context.edits.set({{row.pointer + "/orientation", std::nullopt}, {row.pointer + "/normal", scene::to_json(Vec3(n[0], n[1], n[2]))}},
                          "turn " + row.name);
      show_tooltip("Enter applies");
      break;
    }
    case widget::Kind::seed:
    case widget::Kind::isolevel:
      place("position", pose.points[0]);
      break;
    case widget::Kind::box:
      place("min", pose.points[0]);
      place("max", pose.points[1]);
      break;
    case widget::Kind::rake:
    case widget::Kind::ruler:
      place("from", pose.points[0]);
      place("to", pose.points[1]);
      break;
  }
}

Vec3 to_camera(const PanelContext& context) {
  const render::View& view = context.navigation.view;
  return (view.position - view.target) / view.stretch;
}

void reset(PanelContext& context, const Row& row) {
  // the default pose of a new widget, under the existing name
  const auto fresh =
      make_widget_json(context.scene.scene(), scene::to_string(row.widget.spec.kind), context.scene.bounds, to_camera(context));
  if (!fresh) return;
  const auto node = json::parse(*fresh, "widget");
  if (!node) return;
  TextEdits edits;
  if (row.widget.spec.kind == widget::Kind::cutting_plane) edits.push_back({row.pointer + "/normal", std::nullopt});
  for (const char* key : {"center", "orientation", "position", "from", "to", "min", "max"})
    if (const json::Node* value = node->find(key)) edits.push_back({row.pointer + "/" + key, json::serialize_node(*value)});
  context.edits.set(edits, "reset " + row.name);
}

/// JSON pointer of the widget's item in "clip"; empty if there is none.
std::string find_clip_pointer(const PanelContext& context, const std::string& widget) {
  const auto root = json::parse(context.scene.document().text(), {});
  const json::Node* clips = root ? root->find("clip") : nullptr;
  for (std::size_t i = 0; clips != nullptr && i < clips->items.size(); ++i)
    if (const json::Node* named = clips->items[i].find("widget"); named != nullptr && named->string == widget)
      return "/clip/" + std::to_string(i);
  return {};
}

/// Draws whether the widget clips, and the choice of the side that a plane removes.
void draw_clip(PanelContext& context, const Row& row) {
  const bool plane = row.widget.spec.kind == widget::Kind::cutting_plane;
  if (!plane && row.widget.spec.kind != widget::Kind::box) return;
  const scene::Scene& scene = context.scene.scene();
  const auto clip = std::ranges::find(scene.clip_planes, row.entity, &scene::ClipPlane::widget);
  bool clips = clip != scene.clip_planes.end();
  if (ImGui::Checkbox("clips", &clips)) {
    const std::string item = make_clip_json(scene, row.name, row.widget.spec.kind);
    if (!clips)
      context.edits.remove(find_clip_pointer(context, row.name), row.name + " does not clip");
    else if (!item.empty())
      context.edits.set("/clip/-", item, row.name + " clips");
    else
      context.state.show_message("the scene has as many clip planes as it can have (a box counts as six)", true);
  }
  show_tooltip(plane ? "remove one side of the plane from all items that are clipped by the clip planes"
                     : "remove what is outside the box from all items that are clipped by the clip planes");
  if (!plane || clip == scene.clip_planes.end()) return;
  ImGui::SameLine();
  if (ImGui::SmallButton("other side"))
    context.edits.set(find_clip_pointer(context, row.name) + "/side",
                      scene::to_json(std::string(clip->keep_back_side ? "front" : "behind")), row.name + " clips the other side");
  show_tooltip("remove the other side of the plane");
}

/// Draws the buttons that show a field in the plane.
void draw_plane_slices(PanelContext& context, const Row& row) {
  if (row.widget.spec.kind != widget::Kind::cutting_plane || !ImGui::BeginCombo("##slice", "+ slice in this plane")) return;
  for (const std::string& field : field_names(context.scene.scene()))
    if (ImGui::Selectable(field.c_str()))
      context.edits.set("/slices/-", "{\"field\": " + scene::to_json(field) + ", \"widget\": " + scene::to_json(row.name) + "}",
                        "slice of " + field + " in " + row.name);
  ImGui::EndCombo();
}

void draw_row(PanelContext& context, const Row& row) {
  const widget::Report& state = row.widget.report;
  ImGui::PushID(row.name.c_str());
  const bool open = ImGui::TreeNodeEx("##pose", ImGuiTreeNodeFlags_SpanAvailWidth, "%s", row.name.c_str());
  const char* word = to_string(state.mode);
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(word).x);
  const bool engaged = state.mode != WidgetMode::idle;
  ImGui::TextColored(engaged ? ImVec4(1, 0.8f, 0.3f, 1) : ImVec4(0.6f, 0.6f, 0.6f, 1), "%s", word);
  if (row.widget.spec.kind == widget::Kind::isolevel) ImGui::TextDisabled("level %.5g", state.value);
  if (open) {
    ImGui::TextDisabled("%s, button %d", scene::to_string(row.widget.spec.kind), row.widget.spec.button);
    draw_pose(context, row);
    draw_clip(context, row);
    draw_plane_slices(context, row);
    if (ImGui::Button("Reset")) reset(context, row);
    show_tooltip("reset the widget to its initial pose");
    ImGui::SameLine();
    if (ImGui::Button("Remove"))
      context.edits.set(make_remove_widget_edits(context.scene.scene(), context.scene.document().text(), row.name), "remove " + row.name);
    show_tooltip("remove the widget; slices, seeds and levels that follow it stay where they are");
    ImGui::TreePop();
  }
  ImGui::PopID();
}

void draw_widgets(PanelContext& context) {
  for (const Row& row : rows_of(context.scene.scene())) draw_row(context, row);
  if (!ImGui::BeginCombo("##add", "Add a widget")) return;
  for (const std::string& type : list_widget_types()) {
    std::string label = type;
    std::ranges::replace(label, '_', ' ');
    if (!ImGui::Selectable(label.c_str())) continue;
    const auto fresh = make_add_widget_edits(context.scene.scene(), type, context.scene.bounds, to_camera(context));
    if (fresh)
      context.edits.set(*fresh, "add " + type);
    else
      context.state.show_message(fresh.error().message, true);
  }
  ImGui::EndCombo();
}

}  // namespace

Panel widgets_panel() { return {"Widgets", false, draw_widgets}; }

}  // namespace catena::app
