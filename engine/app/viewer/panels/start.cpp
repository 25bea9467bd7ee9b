// A window without a scene says how to begin.
#include <imgui.h>

#include <filesystem>

#include "engine/app/viewer/panels/panel.h"
#include "engine/app/viewer/shell/file_list.h"
#include "engine/base/text.h"

namespace catena::app {

bool draw_recent(PanelContext& context) {
  bool any = false;
  for (const std::string& path : context.state.recent) {
    any = true;
    ImGui::PushID(path.c_str());
    if (ImGui::Selectable(std::filesystem::path(path).filename().string().c_str())) context.ask(OpenFile{path});
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", path.c_str());
    ImGui::PopID();
  }
  return any;
}

void draw_start(PanelContext& context) {
  const ViewState& state = context.state;
  if (!state.untitled || !state.loading.empty() || context.scene.document().is_modified()) return;
  const Area& area = state.area;
  ImGui::SetNextWindowPos({static_cast<float>(area.x + 0.5 * area.width), static_cast<float>(area.y + 0.5 * area.height)}, 0, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({std::min(340.0f, static_cast<float>(area.width)), 0},
                                      {static_cast<float>(area.width), static_cast<float>(area.height)});
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoBringToFrontOnFocus |
                                      ImGuiWindowFlags_NoFocusOnAppearing;
  if (ImGui::Begin("##start", nullptr, kFlags)) {
    ImGui::TextUnformatted(("Drop a file here: " + alternatives(openable_endings())).c_str());
    ImGui::Spacing();
    const std::string open = menu_words(Action::open) + ("  (" + key_words(Action::open) + ")");
    if (ImGui::Button(open.c_str())) context.ask(Action::open);
    if (!state.recent.empty()) {
      ImGui::Spacing();
      ImGui::TextDisabled("Recent");
      draw_recent(context);
    }
  }
  ImGui::End();
}

}  // namespace catena::app
