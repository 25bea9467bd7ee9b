// SPDX-License-Identifier: MIT
// Panel of the lights: direction, color, intensity, frame, and new lights.
#include <fmt/format.h>

#include "engine/app/viewer/panels/color_widgets.h"

namespace catena::app {

namespace {

void draw_light(Edits& edits, const scene::Light& light, std::size_t index, bool is_only) {
  const std::string pointer = fmt::format("/lights/{}", index);
  ImGui::PushID(static_cast<int>(index));
  if (ImGui::TreeNodeEx("##light", ImGuiTreeNodeFlags_DefaultOpen, "light %zu", index + 1)) {
    edit_color(edits, "colour", light.color, pointer + "/color");
    edit_slider(edits, "intensity", light.intensity, 0, 3, pointer + "/intensity", "%.2f");
    edit_vector(edits, "direction", pointer + "/direction", light.direction, 0.01);
    edit_slider(edits, "angular size", light.angular_size_deg, 0, 30, pointer + "/angular_size", "%.1f deg");
    bool follows = light.follows_camera;
    if (ImGui::Checkbox("fixed to the camera", &follows))
      edits.set(pointer + "/fixed_to", scene::to_json(std::string_view(follows ? "camera" : "scene")), "frame of the light");
    if (ImGui::Button("Remove")) edits.remove(is_only ? "/lights" : pointer, "remove the light");
    ImGui::TreePop();
  }
  ImGui::PopID();
}

void draw_lights(PanelContext& context) {
  const auto& lights = context.scene.scene().illumination.lights;
  const scene::Scene& scene = context.scene.scene();
  const scene::Illumination& light = scene.illumination;
  bool is_lit = light.look == scene::Look::lit || (light.look == scene::Look::automatic && !light.is_unstated());
  if (ImGui::Checkbox("light as linear radiance", &is_lit)) context.edits.set("/look", is_lit ? R"("lit")" : R"("plain")", "look");
  if (lights.empty()) {
    const char* beside = light.look == scene::Look::lit && light.is_unstated() ? "the default light" : "a headlight";
    ImGui::TextDisabled("%s", !light.has_headlight ? "no light" : fmt::format("{}, as no light is stated", beside).c_str());
  }
  bool occludes = light.ambient_occlusion.has_value(), shadows = light.shadows;
  if (ImGui::Checkbox("ambient occlusion", &occludes))
    context.edits.set("/ambient_occlusion", scene::to_json(occludes), "ambient occlusion");
  if (ImGui::Checkbox("shadows of the lights fixed to the scene", &shadows))
    context.edits.set("/shadows", scene::to_json(shadows), "shadows");
  bool halos = light.line_halos.value_or(light.look == scene::Look::lit && light.is_unstated());
  if (ImGui::Checkbox("halos of lines", &halos)) context.edits.set("/line_halos", scene::to_json(halos), "halos of lines");
  for (std::size_t i = 0; i < lights.size(); ++i) draw_light(context.edits, lights[i], i, lights.size() == 1);
  if (ImGui::Button("Add a light"))
    context.edits.set("/lights/-", R"({"direction": [-0.5, 0.7, 1], "fixed_to": "camera", "intensity": 0.8})", "add a light");
}

}  // namespace

Panel lights_panel() { return {"Lights", false, draw_lights}; }

}  // namespace catena::app
