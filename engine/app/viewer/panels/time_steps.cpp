// SPDX-License-Identifier: MIT
// Panel of the time steps: the step shown and the playback speed.
#include <imgui.h>

#include "engine/app/viewer/panels/panel.h"
#include "engine/app/viewer/panels/property_widgets.h"
#include "engine/scene/time_steps.h"
#include "engine/scene/to_json.h"

namespace catena::app {

namespace {

void draw_time(PanelContext& context) {
  const scene::Scene& scene = context.scene.scene();
  const int last = scene::step_count(scene) - 1;
  int step = std::min(scene.time.step, last);
  ImGui::SetNextItemWidth(-1);
  if (ImGui::SliderInt("##step", &step, 0, last, "step %d", ImGuiSliderFlags_AlwaysClamp)) context.push_command(ShowTimeStep{step});
  show_tooltip("time step shown; the keys , and . go to the previous and next step");
  if (ImGui::Button(context.state.playback.is_playing ? "Stop" : "Play")) context.push_command(Action::play_time_steps);
  ImGui::SameLine();
  auto rate = static_cast<float>(scene.time.steps_per_second);
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.6f);
  if (ImGui::SliderFloat("steps/s", &rate, 0.1f, 60, "%.3g", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp))
    context.edits.drag("/time/per_second", scene::to_json(static_cast<double>(rate)), "steps per second");
  if (scene::current_step_time(scene)) ImGui::Text("t = %s", scene::format_time(scene).c_str());
}

bool has_steps(const PanelContext& context) { return scene::step_count(context.scene.scene()) > 1; }

}  // namespace

Panel time_panel() { return {"Time", true, draw_time, has_steps}; }

}  // namespace catena::app
