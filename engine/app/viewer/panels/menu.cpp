// The bar at the top.
#include <imgui.h>

#include "engine/app/viewer/panels/panel.h"

namespace catena::app {

namespace {

void draw_file_menu(PanelContext& context) {
  ViewState& state = context.state;
  if (!ImGui::BeginMenu("File")) return;
  if (ImGui::MenuItem("Open...", "Ctrl+O")) state.ask_open = true;
  if (ImGui::BeginMenu("Open recent", !state.recent.empty())) {
    draw_recent(state);
    ImGui::EndMenu();
  }
  if (ImGui::MenuItem("Save", "Ctrl+S")) state.save.emplace();
  if (ImGui::MenuItem("Save as...", "Ctrl+Shift+S")) state.ask_save = true;
  ImGui::Separator();
  const auto shoot = [&](bool window) {
    state.screenshot.emplace();
    state.screenshot_of_window = window;
  };
  if (ImGui::MenuItem("Picture as PNG", "F12")) shoot(false);
  if (ImGui::MenuItem("Window as PNG", "Shift+F12")) shoot(true);
  ImGui::Separator();
  if (ImGui::MenuItem("Quit", "Ctrl+Q")) state.quit = true;
  ImGui::EndMenu();
}

void draw_edit_menu(PanelContext& context) {
  ViewState& state = context.state;
  const scene::Document& document = context.scene.document();
  if (!ImGui::BeginMenu("Edit")) return;
  const std::string undo = document.can_undo() ? "Undo " + document.undo_what() : "Undo";
  const std::string redo = document.can_redo() ? "Redo " + document.redo_what() : "Redo";
  if (ImGui::MenuItem(undo.c_str(), "Ctrl+Z", false, document.can_undo()))
    if (const Outcome done = context.scene.undo(); !done) state.say(done.error().message, true);
  if (ImGui::MenuItem(redo.c_str(), "Ctrl+Y", false, document.can_redo()))
    if (const Outcome done = context.scene.redo(); !done) state.say(done.error().message, true);
  ImGui::EndMenu();
}

void draw_view_menu(PanelContext& context) {
  ViewState& state = context.state;
  if (!ImGui::BeginMenu("View")) return;
  ImGui::MenuItem("Panels", "Tab", &state.panels);
  ImGui::MenuItem("Full screen", "F11", &state.full_screen);
  ImGui::Separator();
  if (ImGui::MenuItem("First view", "R")) state.moves.reset_view = true;
  if (ImGui::MenuItem("Everything", "A")) state.moves.fit = true;
  if (ImGui::BeginMenu("Along")) {
    constexpr const char *kAxes[2][3] = {{"+x", "+y", "+z"}, {"-x", "-y", "-z"}},
                         *kKeys[2][3] = {{"1", "2", "3"}, {"Shift+1", "Shift+2", "Shift+3"}};
    for (int side = 0; side < 2; ++side)
      for (int axis = 0; axis < 3; ++axis)
        if (ImGui::MenuItem(kAxes[side][axis], kKeys[side][axis])) {
          state.moves.axis = axis;
          state.moves.shift = side == 1;
        }
    ImGui::EndMenu();
  }
  if (ImGui::MenuItem("Orthographic", "O", context.controls.view.orthographic)) state.moves.toggle_projection = true;
  ImGui::Separator();
  ImGui::MenuItem("Turntable", "T", &state.turntable);
  ImGui::MenuItem("Fly", "V", &state.fly);
  ImGui::MenuItem("The mouse is the hand", "H", &context.controls.hand_mode);
  ImGui::EndMenu();
}

}  // namespace

void draw_menu(PanelContext& context) {
  if (!ImGui::BeginMainMenuBar()) return;
  draw_file_menu(context);
  draw_edit_menu(context);
  draw_view_menu(context);
  if (ImGui::BeginMenu("Help")) {
    if (ImGui::MenuItem("Keys and buttons", "F1")) context.state.help = true;
    ImGui::EndMenu();
  }
  ImGui::EndMainMenuBar();
}

}  // namespace catena::app
