// Steps in time: which one is shown, and how fast they go by.
#include <imgui.h>

#include "engine/app/viewer/panels/edit_items.h"
#include "engine/app/viewer/panels/panel.h"
#include "engine/scene/steps.h"
#include "engine/scene/write_values.h"

namespace catena::app {

namespace {

void draw_time(PanelContext& context) {
  const scene::Scene& scene = context.scene.scene();
  const int last = scene::step_count(scene) - 1;
  int step = std::min(scene.time.step, last);
  ImGui::SetNextItemWidth(-1);
  if (ImGui::SliderInt("##step", &step, 0, last, "step %d", ImGuiSliderFlags_AlwaysClamp)) context.ask(ShowStep{step});
  tip("the step that is shown; , and . go to the one before and after");
  if (ImGui::Button(context.state.steps.plays ? "Stop" : "Play")) context.ask(Action::play_steps);
  ImGui::SameLine();
  auto rate = static_cast<float>(scene.time.per_second);
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.6f);
  if (ImGui::SliderFloat("a second", &rate, 0.1f, 60, "%.3g", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp))
    context.edits.drag("/time/per_second", scene::text_of(static_cast<double>(rate)), "steps a second");
  if (scene::time_of_step(scene)) ImGui::Text("t = %s", scene::time_text(scene).c_str());
}

bool has_steps(const PanelContext& context) { return scene::step_count(context.scene.scene()) > 1; }

}  // namespace

Panel time_panel() { return {"Time", true, draw_time, has_steps}; }

}  // namespace catena::app
