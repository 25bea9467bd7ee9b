// SPDX-License-Identifier: MIT
// Panel of the widgets that the probe can move: state, pose, and creation of new ones.
#include <fmt/format.h>
#include <imgui.h>

#include "engine/app/viewer/edit/item_templates.h"
#include "engine/app/viewer/panels/panel.h"
#include "engine/app/viewer/panels/property_widgets.h"
#include "engine/scene/to_json.h"
#include "engine/scene/widgets.h"

namespace catena::app {

namespace {

struct Row {
  std::string name, pointer;
  scene::Widget widget;
};

std::vector<Row> rows_of(const scene::Scene& scene) {
  std::vector<Row> rows;
  scene.entities.each<scene::Widget>([&](scene::Entity e, const scene::Widget& widget) {
    rows.push_back({scene.entities.get<scene::Name>(e).value, fmt::format("/widgets/{}", rows.size()), widget});
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
      double n[3] = {normal.x, normal.y, normal.z};
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

void reset(PanelContext& context, const Row& row) {
  // the default pose of a new widget, under the existing name
  const auto fresh = make_widget_json(context.scene.scene(), scene::to_string(row.widget.spec.kind), context.scene.bounds);
  if (!fresh) return;
  const auto node = json::parse(*fresh, "widget");
  if (!node) return;
  TextEdits edits;
  if (row.widget.spec.kind == widget::Kind::cutting_plane) edits.push_back({row.pointer + "/orientation", std::nullopt});
  for (const char* key : {"center", "normal", "position", "from", "to", "min", "max"})
    if (const json::Node* value = node->find(key))
      if (const auto v = json::as_vec3(*value, key)) edits.push_back({row.pointer + "/" + key, scene::to_json(*v)});
  context.edits.set(edits, "reset " + row.name);
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
    if (ImGui::Button("Reset")) reset(context, row);
    show_tooltip("reset the widget to its initial pose");
    ImGui::SameLine();
    if (ImGui::Button("Remove")) context.edits.remove(row.pointer, "remove " + row.name);
    show_tooltip("remove the widget; first remove the items that follow it, or let them follow another widget");
    ImGui::TreePop();
  }
  ImGui::PopID();
}

void draw_widgets(PanelContext& context) {
  for (const Row& row : rows_of(context.scene.scene())) draw_row(context, row);
  if (!ImGui::BeginCombo("##add", "Add a widget")) return;
  for (const std::string& type : list_widget_types()) {
    if (!ImGui::Selectable(type.c_str())) continue;
    const auto fresh = make_widget_json(context.scene.scene(), type, context.scene.bounds);
    if (fresh)
      context.edits.set("/widgets/-", *fresh, "add " + type);
    else
      context.state.show_message(fresh.error().message, true);
  }
  ImGui::EndCombo();
}

}  // namespace

Panel widgets_panel() { return {"Widgets", false, draw_widgets}; }

}  // namespace catena::app
