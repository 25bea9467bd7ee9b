// SPDX-License-Identifier: MIT
#include <imgui.h>

#include <algorithm>

#include "engine/app/viewer/panels/panel.h"
#include "engine/base/clock.h"

namespace catena::app {

// factories of all panels, each documented in its own file
Panel values_panel(), time_panel(), fields_panel(), volumes_panel(), isosurfaces_panel(), slices_panel(), lines_panel(), glyphs_panel(),
    curves_panel(), points_panel(), meshes_panel(), widgets_panel(), measure_panel(), scalar_bars_panel(), lights_panel(), chain_panel(),
    device_panel(), recording_panel(), view_panel(), quality_panel(), tuning_panel(), times_panel();

namespace {

const std::vector<Panel>& panels_in_order() {
  static const std::vector<Panel> panels{values_panel(),    time_panel(),        fields_panel(),  volumes_panel(), isosurfaces_panel(),
                                         slices_panel(),    lines_panel(),       glyphs_panel(),  curves_panel(),  points_panel(),
                                         meshes_panel(),    widgets_panel(),     measure_panel(), chain_panel(),   device_panel(),
                                         recording_panel(), scalar_bars_panel(), lights_panel(),  view_panel(),    quality_panel(),
                                         tuning_panel(),    times_panel()};
  return panels;
}

float side_width = 320;  // of the only window

void draw_side(PanelContext& context) {
  const ImGuiViewport& view = *ImGui::GetMainViewport();
  const float height = view.WorkSize.y - ImGui::GetFrameHeightWithSpacing();
  constexpr float kMinWidth = 240, kMostOfWindow = 0.7f;
  ImGui::SetNextWindowPos(view.WorkPos);
  ImGui::SetNextWindowSize({side_width, height}, ImGuiCond_Once);
  ImGui::SetNextWindowSizeConstraints({kMinWidth, height}, {std::max(kMinWidth, kMostOfWindow * view.WorkSize.x), height});
  constexpr ImGuiWindowFlags kFixed =
      ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNavFocus;
  if (ImGui::Begin("##side", nullptr, kFixed)) {
    side_width = ImGui::GetWindowWidth();
    ImGui::PushItemWidth(0.55f * side_width);
    for (const Panel& panel : panels_in_order()) {
      if (panel.is_relevant != nullptr && !panel.is_relevant(context)) continue;
      ImGui::SetNextItemOpen(panel.is_initially_open, ImGuiCond_Once);
      if (!ImGui::CollapsingHeader(panel.title)) continue;
      ImGui::PushID(panel.title);
      panel.draw(context);
      ImGui::PopID();
    }
    ImGui::PopItemWidth();
  }
  ImGui::End();
}

}  // namespace

void ViewState::show_message(std::string text, bool is_error) {
  messages.push_back({std::move(text), is_error, now_ns()});
  while (messages.size() > kMaxMessages) messages.pop_front();
}

float side_panel_width() { return side_width; }

Insets interface_insets() { return {side_width, ImGui::GetFrameHeight(), ImGui::GetFrameHeightWithSpacing()}; }

void draw_interface(PanelContext& context) {
  ViewState& state = context.state;
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Left) || ImGui::IsMouseClicked(ImGuiMouseButton_Right)) ++state.edit.gesture;
  // with panels hidden, the menu appears when the pointer is where it would be
  const bool looked_for =
      state.pointer_y < ImGui::GetFrameHeight() && state.pointer_y >= 0 && !state.pointer_pressed && state.pointer_has_moved;
  if (state.show_panels || looked_for || ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId)) draw_menu(context);
  if (state.show_panels) draw_side(context);
  draw_status(context);
  draw_welcome(context);
  draw_dialogs(context);
  draw_file_dialogs(context);
}

}  // namespace catena::app
