// SPDX-License-Identifier: MIT
// Modal dialogs: messages and questions above all other panels.
#include <imgui.h>

#include <ctime>
#include <filesystem>
#include <string_view>

#include "engine/app/viewer/panels/panel.h"

namespace catena::app {

namespace {

void centre_next() { ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, {0.5f, 0.5f}); }

std::string file_name_of(const std::string& path) { return std::filesystem::path(path).filename().string(); }

void draw_help(ViewState& state) {
  const ImGuiViewport& view = *ImGui::GetMainViewport();
  centre_next();
  ImGui::SetNextWindowSizeConstraints({0, 0}, view.WorkSize);
  if (ImGui::Begin("Keys and buttons", &state.show_help, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse)) {
    std::string_view section;
    for (const KeyHelp& key : key_list()) {
      if (section != key.section) {
        if (!section.empty()) ImGui::Spacing();
        section = key.section;
        ImGui::TextColored({0.6f, 0.8f, 1, 1}, "%s", key.section.c_str());
      }
      ImGui::TextUnformatted(key.keys.c_str());
      ImGui::SameLine(190);
      ImGui::TextUnformatted(key.description.c_str());
    }
  }
  ImGui::End();
}

/// Begins the modal of that title while `is_open`. True: the caller draws its content and calls EndPopup.
bool begin_question(const char* title, bool is_open) {
  if (is_open && !ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
  centre_next();
  return ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove);
}

constexpr ImGuiKey_ kNoKey = ImGuiKey_COUNT;

bool button(const char* label, ImGuiKey_ key) {
  const bool pressed = ImGui::Button(label, {110, 0});
  const bool by_key = key != kNoKey && ImGui::IsKeyPressed(ImGui::GetKeyIndex(key), false);
  return pressed || by_key;
}

/// Draws a button that answers the dialog: requests the command and closes the dialog.
void answer(PanelContext& context, const char* label, ImGuiKey_ key, Command command) {
  if (!button(label, key)) return;
  context.push_command(std::move(command));
  ImGui::CloseCurrentPopup();
}

void draw_unsaved(PanelContext& context) {
  const std::optional<PendingLeave>& leaving = context.state.dialogs.unsaved_changes;
  if (!begin_question("Close this scene?", leaving.has_value())) return;
  if (!leaving) {
    ImGui::CloseCurrentPopup();
    return ImGui::EndPopup();
  }
  const bool modified = context.scene.document().is_modified();
  if (modified) ImGui::Text("%s has unsaved changes.", file_name_of(context.scene.document().path()).c_str());
  if (leaving->quits() && context.haptic_session.recording().is_recording())
    ImGui::Text("%s is being recorded: quitting ends the recording.", file_name_of(context.haptic_session.recording().path()).c_str());
  ImGui::Spacing();
  if (modified) {
    answer(context, "Save", ImGuiKey_Enter, UnsavedChangesChoice::save);
    ImGui::SetItemDefaultFocus();
    ImGui::SameLine();
    answer(context, "Discard", kNoKey, UnsavedChangesChoice::discard);
  } else {
    answer(context, "Quit", ImGuiKey_Enter, UnsavedChangesChoice::discard);
    ImGui::SetItemDefaultFocus();
  }
  ImGui::SameLine();
  answer(context, "Cancel", ImGuiKey_Escape, UnsavedChangesChoice::cancel);
  ImGui::EndPopup();
}

std::string words_of_time(std::int64_t at_s) {
  const auto time = static_cast<std::time_t>(at_s);
  std::tm parts{};
  char words[64] = "";
  if (::localtime_r(&time, &parts) != nullptr) std::strftime(words, sizeof words, "%d %B, %H:%M", &parts);
  return words;
}

void draw_left(PanelContext& context, bool is_open) {
  const std::optional<OrphanedAutosave>& left = context.state.dialogs.recovery;
  if (!begin_question("Unsaved changes of an earlier run", is_open)) return;
  if (!left) {
    ImGui::CloseCurrentPopup();
    return ImGui::EndPopup();
  }
  ImGui::Text("%s had unsaved changes when the window closed", file_name_of(context.scene.document().path()).c_str());
  ImGui::Text("(%s).", words_of_time(left->saved_at_s).c_str());
  ImGui::Spacing();
  answer(context, "Restore", ImGuiKey_Enter, RecoveryChoice::restore);
  ImGui::SetItemDefaultFocus();
  ImGui::SameLine();
  answer(context, "Discard", kNoKey, RecoveryChoice::discard);
  ImGui::SameLine();
  answer(context, "Later", ImGuiKey_Escape, RecoveryChoice::later);
  ImGui::EndPopup();
}

void draw_changed(PanelContext& context, bool is_open) {
  using OnDisk = scene::Document::DiskState;
  const std::optional<OnDisk> changed = context.state.dialogs.file_conflict;
  if (!begin_question("The file has changed on disk", is_open)) return;
  if (!changed) {
    ImGui::CloseCurrentPopup();
    return ImGui::EndPopup();
  }
  const std::string name = file_name_of(context.scene.document().path());
  const char* const what = *changed == OnDisk::changed   ? "%s was changed by another program."
                           : *changed == OnDisk::missing ? "%s was removed or renamed by another program."
                                                         : "%s is not a readable file any more.";
  ImGui::Text(what, name.c_str());
  ImGui::Spacing();
  if (*changed != OnDisk::not_a_file) {
    answer(context, *changed == OnDisk::changed ? "Overwrite" : "Write the file", kNoKey, FileConflictChoice::overwrite);
    ImGui::SameLine();
  }
  if (*changed == OnDisk::changed) {
    answer(context, "Reload", kNoKey, FileConflictChoice::take_disk_version);
    ImGui::SameLine();
  }
  answer(context, "Save as...", ImGuiKey_Enter, FileConflictChoice::save_as);
  ImGui::SetItemDefaultFocus();
  ImGui::SameLine();
  answer(context, "Cancel", ImGuiKey_Escape, FileConflictChoice::cancel);
  ImGui::EndPopup();
}

void draw_dropped(PanelContext& context, bool is_open) {
  const std::optional<std::string>& dropped = context.state.dialogs.dropped_file;
  if (!begin_question("A file was dropped", is_open)) return;
  if (!dropped) {
    ImGui::CloseCurrentPopup();
    return ImGui::EndPopup();
  }
  ImGui::TextUnformatted(file_name_of(*dropped).c_str());
  ImGui::Spacing();
  answer(context, "Add to the scene", ImGuiKey_Enter, DroppedFileChoice::add);
  ImGui::SetItemDefaultFocus();
  ImGui::SameLine();
  answer(context, "Open instead", kNoKey, DroppedFileChoice::open);
  ImGui::SameLine();
  answer(context, "Cancel", ImGuiKey_Escape, DroppedFileChoice::cancel);
  ImGui::EndPopup();
}

}  // namespace

void draw_dialogs(PanelContext& context) {
  if (context.state.show_help) draw_help(context.state);
  // one dialog at a time
  const ViewState& state = context.state;
  draw_unsaved(context);
  draw_changed(context, state.dialogs.file_conflict && !state.dialogs.unsaved_changes);
  draw_dropped(context, state.dialogs.dropped_file && !state.dialogs.unsaved_changes && !state.dialogs.file_conflict);
  draw_left(context,
            state.dialogs.recovery && !state.dialogs.unsaved_changes && !state.dialogs.dropped_file && !state.dialogs.file_conflict);
}

}  // namespace catena::app
