// The bar at the top.
#include <imgui.h>

#include "engine/app/viewer/panel.h"

namespace catena::app {

void draw_menu(PanelContext& context) {
  ViewState& state = context.state;
  const scene::Document& document = context.scene.document();
  if (!ImGui::BeginMainMenuBar()) return;
  if (ImGui::BeginMenu("File")) {
    if (ImGui::MenuItem("Open...", "Ctrl+O")) state.ask_open = true;
    if (ImGui::MenuItem("Save", "Ctrl+S")) state.save = document.path();
    if (ImGui::MenuItem("Save as...", "Ctrl+Shift+S")) state.ask_save = true;
    if (ImGui::MenuItem("Quit", "Q")) state.quit = true;
    ImGui::EndMenu();
  }
  if (ImGui::BeginMenu("Edit")) {
    const std::string undo = document.can_undo() ? "Undo " + document.undo_what() : "Undo";
    const std::string redo = document.can_redo() ? "Redo " + document.redo_what() : "Redo";
    if (ImGui::MenuItem(undo.c_str(), "Ctrl+Z", false, document.can_undo()))
      if (const Outcome done = context.scene.undo(); !done) state.say(done.error().message, true);
    if (ImGui::MenuItem(redo.c_str(), "Ctrl+Y", false, document.can_redo()))
      if (const Outcome done = context.scene.redo(); !done) state.say(done.error().message, true);
    ImGui::EndMenu();
  }
  if (ImGui::BeginMenu("View")) {
    ImGui::MenuItem("Panels", "Tab", &state.panels);
    ImGui::MenuItem("Turntable", "T", &state.turntable);
    ImGui::EndMenu();
  }
  if (ImGui::BeginMenu("Help")) {
    if (ImGui::MenuItem("Keys", "F1")) state.help = true;
    ImGui::EndMenu();
  }
  ImGui::EndMainMenuBar();
}

}  // namespace catena::app
