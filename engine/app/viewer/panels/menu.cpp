// SPDX-License-Identifier: MIT
// The menu bar at the top: entries that request the commands.
#include <imgui.h>

#include <utility>
#include <vector>

#include "engine/app/viewer/panels/panel.h"

namespace catena::app {

namespace {

/// Entry with a label other than the command's own, such as "Undo isolevel".
void entry(PanelContext& context, Action action, const std::string& words, bool checked = false, bool enabled = true) {
  if (ImGui::MenuItem(words.c_str(), shortcut_label(action).c_str(), checked, enabled)) context.push_command(action);
}
void entry(PanelContext& context, Action action, bool checked = false) { entry(context, action, menu_label(action), checked); }

/// Fields of the data file that is shown without a scene of its own, such as the series of a folder of DICOM files.
void draw_grids_menu(PanelContext& context) {
  std::vector<OpenFile> grids;
  const scene::Scene& scene = std::as_const(context.scene).scene();
  if (!context.state.owns_file && !context.state.is_untitled)
    scene.entities.each<scene::FieldSource>([&](scene::Entity, const scene::FieldSource& source) {
      if (source.file && !source.file->grid.empty()) grids.push_back({source.file->path, source.file->grid});
    });
  if (!ImGui::BeginMenu("Open field of this file", grids.size() > 1)) return;
  for (const OpenFile& grid : grids)
    if (ImGui::MenuItem(grid.grid.c_str())) context.push_command(grid);
  ImGui::EndMenu();
}

void draw_file_menu(PanelContext& context) {
  if (!ImGui::BeginMenu("File")) return;
  entry(context, Action::open);
  if (ImGui::BeginMenu("Open recent", !context.state.recent_files.empty())) {
    draw_recent_files(context);
    ImGui::EndMenu();
  }
  draw_grids_menu(context);
  entry(context, Action::add, menu_label(Action::add), false, !context.state.is_untitled);
  entry(context, Action::save);
  entry(context, Action::save_as);
  ImGui::Separator();
  entry(context, Action::save_image);
  entry(context, Action::save_window_image);
  ImGui::Separator();
  entry(context, Action::quit);
  ImGui::EndMenu();
}

void draw_edit_menu(PanelContext& context) {
  if (!ImGui::BeginMenu("Edit")) return;
  const scene::Document& document = context.scene.document();
  const auto with = [](Action action, bool can, const std::string& what) { return menu_label(action) + (can ? " " + what : ""); };
  const bool undo = document.can_undo(), redo = document.can_redo();
  entry(context, Action::undo, with(Action::undo, undo, document.undo_label()), false, undo);
  entry(context, Action::redo, with(Action::redo, redo, document.redo_label()), false, redo);
  ImGui::EndMenu();
}

void draw_view_menu(PanelContext& context) {
  const ViewState& state = context.state;
  const Navigation& controls = context.navigation;
  if (!ImGui::BeginMenu("View")) return;
  entry(context, Action::toggle_panels, state.show_panels);
  entry(context, Action::toggle_fullscreen, state.is_fullscreen);
  ImGui::Separator();
  entry(context, Action::reset_view);
  entry(context, Action::fit_view);
  if (ImGui::BeginMenu("Along")) {
    for (const Action action : {Action::view_along_plus_x, Action::view_along_plus_y, Action::view_along_plus_z, Action::view_along_minus_x,
                                Action::view_along_minus_y, Action::view_along_minus_z})
      entry(context, action);
    ImGui::EndMenu();
  }
  entry(context, Action::toggle_projection, controls.view.orthographic);
  entry(context, Action::toggle_ortho_views, controls.ortho.is_on);
  ImGui::Separator();
  entry(context, Action::toggle_turntable, controls.turntable);
  entry(context, Action::toggle_fly, controls.fly);
  entry(context, Action::toggle_probe_mode, controls.probe_mode);
  ImGui::EndMenu();
}

}  // namespace

void draw_menu(PanelContext& context) {
  if (!ImGui::BeginMainMenuBar()) return;
  draw_file_menu(context);
  draw_edit_menu(context);
  draw_view_menu(context);
  if (ImGui::BeginMenu("Help")) {
    entry(context, Action::toggle_help);
    ImGui::EndMenu();
  }
  ImGui::EndMainMenuBar();
}

}  // namespace catena::app
