// SPDX-License-Identifier: MIT
// Panel of the environment: background, visual aids, stereo, projection, title.
#include <cstring>

#include "engine/app/viewer/panels/color_widgets.h"
#include "engine/base/json_edit.h"

namespace catena::app {

namespace {

/// JSON text of the object at a top-level key; std::nullopt if there is none.
std::optional<std::string> stated_object(const PanelContext& context, const std::string& key) {
  const auto root = json::parse(context.scene.document().text(), "scene");
  const json::Node* node = root ? root->find(key) : nullptr;
  if (node == nullptr || node->kind != json::Kind::object) return std::nullopt;
  return json::serialize_node(*node);
}

/// Edits a top-level key that is true, false or an object. Switching it back on restores the object that it had.
void edit_aid(PanelContext& context, Edits& edits, const char* label, const std::string& key, bool on, const char* hint) {
  const std::string pointer = "/" + key;
  const bool clicked = ImGui::Checkbox(label, &on);
  show_short_tooltip(hint);
  if (!clicked) return;
  auto& disabled_text = context.state.appearance.disabled_text;
  if (on) {
    edits.set(pointer, disabled_text.contains(key) ? disabled_text[key] : "true", label);
    return;
  }
  if (const auto stated = stated_object(context, key)) disabled_text[key] = *stated;
  edits.set(pointer, "false", label);
}

void draw_title(Edits& edits, const std::string& title) {
  char text[200] = {};
  std::strncpy(text, title.c_str(), sizeof text - 1);
  if (ImGui::InputText("title", text, sizeof text, ImGuiInputTextFlags_EnterReturnsTrue))
    edits.set("/title", scene::to_json(text), "title");
  show_short_tooltip("title above the image; Enter applies");
}

void choose_projection(PanelContext& context) {
  const bool before = context.navigation.view.orthographic;
  int projection = before ? 1 : 0;
  if (ImGui::Combo("projection", &projection, "perspective\0orthographic\0") && (projection == 1) != before)
    context.push_command(Action::toggle_projection);
}

void choose_stereo(PanelContext& context) {
  const scene::StereoMode mode = context.scene.scene().stereo.mode;
  if (!ImGui::BeginCombo("stereo", std::string(scene::to_string(mode)).c_str())) return;
  for (int i = 0; i < scene::kStereoModeCount; ++i) {
    const auto one = static_cast<scene::StereoMode>(i);
    if (ImGui::Selectable(std::string(scene::to_string(one)).c_str(), one == mode)) context.push_command(SetStereoMode{one});
  }
  ImGui::EndCombo();
}

void draw_scene_view(PanelContext& context) {
  Edits& edits = context.edits;
  const scene::Scene& scene = context.scene.scene();
  if (scene.background.transparent)
    ImGui::TextDisabled("transparent background");
  else
    edit_color(edits, "background", scene.background.color, "/background");
  edit_aid(context, edits, "bounding box", "bounding_box", scene.bounding_box.has_value(), "edges of the bounding box");
  ImGui::SameLine();
  edit_aid(context, edits, "axes", "axes", scene.axes.has_value(), "three edges of the bounding box with ticks and numbers");
  edit_aid(context, edits, "ground", "ground", scene.ground.has_value(), "checkerboard below the scene");
  ImGui::SameLine();
  edit_aid(context, edits, "marker", "orientation_marker", scene.annotations.orientation_marker.has_value(),
           "three arrows in the corner of the image, along x, y and z");
  ImGui::SameLine();
  edit_aid(context, edits, "fog", "fog", scene.fog.has_value(), "distant items fade to the background colour");
  if (scene.fog) {
    auto maximum = static_cast<float>(scene.fog->max_opacity);
    if (ImGui::SliderFloat("fog at the far end", &maximum, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp)) {
      const std::string value = scene::to_json(round_within(maximum, 0, 1, 1000));
      if (stated_object(context, "fog"))
        edits.drag("/fog/max_opacity", value, "fog");
      else
        edits.drag("/fog", "{\"max_opacity\": " + value + "}", "fog");
    }
  }
  edit_vector(edits, "stretch", "/stretch", scene.stretch, 0);
  show_short_tooltip("factors of the image along x, y and z; measuring and forces stay in world units; A shows everything");
  choose_projection(context);
  show_short_tooltip("key O switches the projection");
  choose_stereo(context);
  show_short_tooltip("key F2 selects the next stereo mode");
  draw_title(edits, scene.annotations.title);
}

}  // namespace

Panel view_panel() { return {"View", false, draw_scene_view}; }

}  // namespace catena::app
