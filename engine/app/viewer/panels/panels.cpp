#include <imgui.h>

#include "engine/app/viewer/panels/panel.h"
#include "engine/base/clock.h"

namespace catena::app {

namespace {

template <class T>
bool has_any(const PanelContext& context) {
  return context.scene.scene().world.count<T>() > 0;
}

constexpr Panel kPanels[] = {
    {"Values", false, draw_values},
    {"Fields", true, draw_fields},
    {"Volumes", true, draw_transfer, has_any<scene::Volume>},
    {"Isosurfaces", true, draw_isosurfaces, has_any<scene::Isosurface>},
    {"Slices", false, draw_slices, has_any<scene::Slice>},
    {"Lines", false, draw_lines, has_any<scene::StreamlineSet>},
    {"Meshes", false, draw_meshes, has_any<scene::SurfaceMesh>},
    {"Widgets", false, draw_widgets},
    {"Chain", false, draw_chain},
    {"Device", false, draw_device},
    {"Recording", false, draw_recording},
    {"View", false, draw_scene_view},
    {"Quality", false, draw_quality},
    {"Times", false, draw_times},
};

void draw_side(PanelContext& context) {
  const ImGuiViewport& view = *ImGui::GetMainViewport();
  ImGui::SetNextWindowPos(view.WorkPos);
  ImGui::SetNextWindowSize({kSideWidth, view.WorkSize.y - ImGui::GetFrameHeightWithSpacing()});
  constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNavFocus;
  if (ImGui::Begin("##side", nullptr, kFixed)) {
    ImGui::PushItemWidth(0.55f * kSideWidth);
    for (const Panel& panel : kPanels) {
      if (panel.wanted != nullptr && !panel.wanted(context)) continue;
      ImGui::SetNextItemOpen(panel.open_at_first, ImGuiCond_Once);
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

void ViewState::say(std::string text, bool is_error) {
  messages.push_back({std::move(text), is_error, now_ns()});
  while (messages.size() > kMessages) messages.pop_front();
}

bool PanelContext::edit(std::string_view pointer, const std::string& value, const std::string& what, const std::string& drag) {
  const Outcome done = scene.set(pointer, value, what, drag);
  if (!done) state.say(done.error().message, true);
  return static_cast<bool>(done);
}

bool PanelContext::remove(std::string_view pointer, const std::string& what) {
  const Outcome done = scene.remove(pointer, what);
  if (!done) state.say(done.error().message, true);
  return static_cast<bool>(done);
}

bool PanelContext::apply(const std::vector<scene::Document::Edit>& edits, const std::string& what, const std::string& drag) {
  const Outcome done = scene.apply(edits, what, drag);
  if (!done) state.say(done.error().message, true);
  return static_cast<bool>(done);
}

Edges interface_edges() { return {kSideWidth, ImGui::GetFrameHeight(), ImGui::GetFrameHeightWithSpacing()}; }

void draw_interface(PanelContext& context) {
  const ViewState& state = context.state;
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Left) || ImGui::IsMouseClicked(ImGuiMouseButton_Right)) ++context.state.look.press;
  // without panels the menu comes down where the pointer looks for it
  const bool looked_for = state.pointer_y < ImGui::GetFrameHeight() && state.pointer_y >= 0 && !state.pointer_pressed && state.pointer_seen;
  if (state.panels || looked_for || ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId)) draw_menu(context);
  if (state.panels) draw_side(context);
  draw_status(context);
  draw_start(context);
  draw_dialogs(context);
  draw_file_dialogs(context);
}

}  // namespace catena::app
