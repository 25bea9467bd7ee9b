// The bar at the top: entries that ask for the commands of shell/commands.h.
#include <imgui.h>

#include "engine/app/viewer/panels/panel.h"

namespace catena::app {

namespace {

/// Another word than the command's own: "Undo isolevel".
void entry(PanelContext& context, Action action, const std::string& words, bool checked = false, bool enabled = true) {
  if (ImGui::MenuItem(words.c_str(), key_words(action).c_str(), checked, enabled)) context.ask(action);
}
void entry(PanelContext& context, Action action, bool checked = false) { entry(context, action, menu_words(action), checked); }

void draw_file_menu(PanelContext& context) {
  if (!ImGui::BeginMenu("File")) return;
  entry(context, Action::open);
  if (ImGui::BeginMenu("Open recent", !context.state.recent.empty())) {
    draw_recent(context);
    ImGui::EndMenu();
  }
  entry(context, Action::save);
  entry(context, Action::save_as);
  ImGui::Separator();
  entry(context, Action::picture);
  entry(context, Action::window_picture);
  ImGui::Separator();
  entry(context, Action::quit);
  ImGui::EndMenu();
}

void draw_edit_menu(PanelContext& context) {
  if (!ImGui::BeginMenu("Edit")) return;
  const scene::Document& document = context.scene.document();
  const auto with = [](Action action, bool can, const std::string& what) { return menu_words(action) + (can ? " " + what : ""); };
  const bool undo = document.can_undo(), redo = document.can_redo();
  entry(context, Action::undo, with(Action::undo, undo, document.undo_what()), false, undo);
  entry(context, Action::redo, with(Action::redo, redo, document.redo_what()), false, redo);
  ImGui::EndMenu();
}

void draw_view_menu(PanelContext& context) {
  const ViewState& state = context.state;
  const Controls& controls = context.controls;
  if (!ImGui::BeginMenu("View")) return;
  entry(context, Action::panels, state.panels);
  entry(context, Action::full_screen, state.full_screen);
  ImGui::Separator();
  entry(context, Action::first_view);
  entry(context, Action::fit);
  if (ImGui::BeginMenu("Along")) {
    for (const Action action : {Action::along_x, Action::along_y, Action::along_z, Action::against_x, Action::against_y, Action::against_z})
      entry(context, action);
    ImGui::EndMenu();
  }
  entry(context, Action::projection, controls.view.orthographic);
  ImGui::Separator();
  entry(context, Action::turntable, controls.turntable);
  entry(context, Action::fly, controls.fly);
  entry(context, Action::hand_mode, controls.hand_mode);
  ImGui::EndMenu();
}

}  // namespace

void draw_menu(PanelContext& context) {
  if (!ImGui::BeginMainMenuBar()) return;
  draw_file_menu(context);
  draw_edit_menu(context);
  draw_view_menu(context);
  if (ImGui::BeginMenu("Help")) {
    entry(context, Action::help);
    ImGui::EndMenu();
  }
  ImGui::EndMainMenuBar();
}

}  // namespace catena::app
