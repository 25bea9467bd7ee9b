// What is asked or told above everything else.
#include <imgui.h>

#include "engine/app/viewer/panel.h"

namespace catena::app {

void draw_dialogs(PanelContext& context) {
  ViewState& state = context.state;
  if (state.help) {
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, {0.5f, 0.5f});
    if (ImGui::Begin("Keys", &state.help, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse))
      ImGui::TextUnformatted(key_help().data(), key_help().data() + key_help().size());
    ImGui::End();
  }
}

}  // namespace catena::app
