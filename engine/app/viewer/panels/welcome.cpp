// SPDX-License-Identifier: MIT
// Panel shown when no scene is open: openable file types, the command Open, recent files.
#include <imgui.h>

#include <algorithm>
#include <filesystem>

#include "engine/app/viewer/panels/panel.h"
#include "engine/app/viewer/scene/file_browser.h"
#include "engine/base/console.h"
#include "engine/base/text.h"

namespace catena::app {

namespace {
constexpr float kTextWidth = 480;
}

bool draw_recent_files(PanelContext& context) {
  bool any = false;
  for (const std::string& path : context.state.recent_files) {
    any = true;
    ImGui::PushID(path.c_str());
    if (ImGui::Selectable(std::filesystem::path(path).filename().string().c_str())) context.push_command(OpenFile{path});
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", path.c_str());
    ImGui::PopID();
  }
  return any;
}

void draw_loading(const std::string& source) {
  const ImGuiViewport& view = *ImGui::GetMainViewport();
  ImGui::SetNextWindowPos(view.GetWorkCenter(), 0, {0.5f, 0.5f});
  if (ImGui::Begin("##loading", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs)) {
    ImGui::TextUnformatted(("Loading " + std::filesystem::path(source).filename().string()).c_str());
    ImGui::TextDisabled("%s", activity().c_str());
  }
  ImGui::End();
}

void draw_welcome(PanelContext& context) {
  const ViewState& state = context.state;
  if (!state.is_untitled || !state.loading_path.empty() || context.scene.document().is_modified()) return;
  const Area& area = state.image_area;
  ImGui::SetNextWindowPos({static_cast<float>(area.x + 0.5 * area.width), static_cast<float>(area.y + 0.5 * area.height)}, 0, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({std::min(340.0f, static_cast<float>(area.width)), 0},
                                      {static_cast<float>(area.width), static_cast<float>(area.height)});
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoBringToFrontOnFocus |
                                      ImGuiWindowFlags_NoFocusOnAppearing;
  if (ImGui::Begin("##start", nullptr, kFlags)) {
    ImGui::PushTextWrapPos(std::min(kTextWidth, static_cast<float>(area.width) - 2 * ImGui::GetStyle().WindowPadding.x));
    ImGui::TextUnformatted(("Drop a file here: " + join_alternatives(openable_extensions())).c_str());
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
    const std::string open = menu_label(Action::open) + ("  (" + shortcut_label(Action::open) + ")");
    if (ImGui::Button(open.c_str())) context.push_command(Action::open);
    if (!state.recent_files.empty()) {
      ImGui::Spacing();
      ImGui::TextDisabled("Recent");
      draw_recent_files(context);
    }
  }
  ImGui::End();
}

}  // namespace catena::app
