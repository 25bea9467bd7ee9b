// SPDX-License-Identifier: MIT
// Dialogs Open and Save as: the files of a folder, and a text field for a path, with completion by Tab.
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "engine/app/viewer/panels/panel.h"
#include "engine/app/viewer/scene/file_browser.h"

namespace catena::app {

namespace {

namespace fs = std::filesystem;

/// State of one dialog, retained between frames and between uses.
struct Browser {
  std::string folder;
  std::vector<FileEntry> entries;
  std::string problem;  ///< reason why the folder cannot be listed; empty: it was listed
  std::array<char, 4096> typed{};
  bool scenes_only = false, focus = false, asks_overwrite = false;

  void go(const std::string& to) {
    folder = to;
    auto list = list_folder(folder, scenes_only);
    problem = list ? "" : list.error().message;
    entries = list ? std::move(*list) : std::vector<FileEntry>();
  }
  void type(const std::string& text) {
    const std::size_t length = std::min(text.size(), typed.size() - 1);
    std::copy_n(text.begin(), length, typed.begin());
    typed[length] = '\0';
    asks_overwrite = false;
  }
};

std::string size_words(std::uintmax_t bytes) {
  char words[32];
  const double mb = 1e-6 * static_cast<double>(bytes);
  std::snprintf(words, sizeof words, mb >= 1 ? "%.0f MB" : "%.0f kB", mb >= 1 ? mb : std::max(1.0, 1e3 * mb));
  return words;
}

/// The scene's own folder; when a scene without a file is saved, the folder in which the program was started.
std::string start_folder(const PanelContext& context, bool saves = false) {
  std::error_code code;
  fs::path folder = fs::absolute(context.scene.document().path(), code).parent_path();
  if (code || !fs::is_directory(folder, code) || (saves && !context.state.owns_file)) folder = fs::current_path(code);
  return folder.lexically_normal().string();
}

/// Completes the path by Tab. The undo history is emptied, since its positions are those of the shorter text.
int complete(ImGuiInputTextCallbackData* data) {
  if (data->EventFlag != ImGuiInputTextFlags_CallbackCompletion) return 0;
  const Browser& browser = *static_cast<const Browser*>(data->UserData);
  const std::string longer = complete_path(browser.folder, std::string(data->Buf, static_cast<std::size_t>(data->BufTextLen)));
  data->DeleteChars(0, data->BufTextLen);
  data->InsertChars(0, longer.c_str());
  auto& history = ImGui::GetCurrentContext()->InputTextState.Stb.undostate;
  history.undo_point = 0;
  history.undo_char_point = 0;
  history.redo_point = STB_TEXTEDIT_UNDOSTATECOUNT;
  history.redo_char_point = STB_TEXTEDIT_UNDOCHARCOUNT;
  return 0;
}

/// Draws the list of files. True: a file was double-clicked (its name is in the text field).
bool draw_list(Browser& browser) {
  bool chosen = false;
  std::string to;
  ImGui::TextDisabled("%s", browser.folder.c_str());
  if (ImGui::BeginChild("##files", {520, 260}, true)) {
    if (fs::path(browser.folder).has_relative_path() && ImGui::Selectable("../")) to = fs::path(browser.folder).parent_path().string();
    for (const FileEntry& entry : browser.entries) {
      ImGui::PushID(entry.name.c_str());
      const bool clicked = ImGui::Selectable((entry.name + (entry.is_folder ? "/" : "")).c_str(), entry.name == browser.typed.data(),
                                             ImGuiSelectableFlags_AllowDoubleClick);
      const bool twice = clicked && ImGui::IsMouseDoubleClicked(0);
      if (!entry.is_folder) {
        ImGui::SameLine(430);
        ImGui::TextDisabled("%s", size_words(entry.bytes).c_str());
      }
      if (clicked && entry.is_folder) to = (fs::path(browser.folder) / entry.name).string();
      if (clicked && !entry.is_folder) browser.type(entry.name);
      chosen = chosen || (twice && !entry.is_folder);
      ImGui::PopID();
    }
    if (!browser.problem.empty()) ImGui::TextWrapped("%s", browser.problem.c_str());
  }
  ImGui::EndChild();
  if (!to.empty()) browser.go(to);
  return chosen;
}

/// Draws the text field for the path. True: Enter was pressed.
bool draw_typed(Browser& browser) {
  if (std::exchange(browser.focus, false)) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(520);
  constexpr ImGuiInputTextFlags kFlags =
      ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackCompletion | ImGuiInputTextFlags_AutoSelectAll;
  const bool entered = ImGui::InputText("##path", browser.typed.data(), browser.typed.size(), kFlags, complete, &browser);
  if (ImGui::IsItemEdited()) browser.asks_overwrite = false;
  return entered;
}

bool begin(const char* title, bool& asked, Browser& browser, const PanelContext& context, const std::string& typed) {
  if (std::exchange(asked, false)) {
    ImGui::OpenPopup(title);
    browser.go(browser.folder.empty() ? start_folder(context) : browser.folder);
    browser.type(typed);
    browser.focus = true;
  }
  ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, {0.5f, 0.5f});
  return ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove);
}

bool cancelled() {
  const bool pressed = ImGui::Button("Cancel", {110, 0});
  return pressed || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false);
}

/// Enters a typed folder and returns false; stores any other path in `path` and returns true.
bool is_answer(Browser& browser, std::string& path) {
  if (browser.typed[0] == '\0') return false;
  path = resolve_typed_path(browser.folder, browser.typed.data());
  std::error_code code;
  if (!fs::is_directory(path, code)) return true;
  browser.go(path.size() > 1 && path.ends_with('/') ? path.substr(0, path.size() - 1) : path);
  browser.type("");
  browser.focus = true;
  return false;
}

/// Draws the dialog that opens a file, or adds one to the scene.
template <class Chosen>
void draw_open(PanelContext& context, const char* title, bool& asked) {
  static Browser browser;
  if (!begin(title, asked, browser, context, "")) return;
  bool chosen = draw_list(browser);
  chosen = draw_typed(browser) || chosen;
  chosen = ImGui::Button(title, {110, 0}) || chosen;
  ImGui::SameLine();
  const bool leaves = cancelled();
  std::string path;
  if (chosen && is_answer(browser, path)) {
    context.push_command(Chosen{path});
    ImGui::CloseCurrentPopup();
  } else if (leaves) {
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

void draw_save(PanelContext& context) {
  static Browser browser;
  browser.scenes_only = true;
  ViewState& state = context.state;
  if (state.dialogs.show_save_as) browser.folder = start_folder(context, true);
  if (!begin("Save as", state.dialogs.show_save_as, browser, context, fs::path(context.scene.document().path()).filename().string()))
    return;
  bool chosen = draw_list(browser);
  chosen = draw_typed(browser) || chosen;
  std::string path;
  std::error_code code;
  if (browser.asks_overwrite) {
    ImGui::TextColored({1, 0.7f, 0.4f, 1}, "%s exists already.", fs::path(browser.typed.data()).filename().string().c_str());
    chosen = ImGui::Button("Overwrite", {110, 0});
  } else {
    chosen = ImGui::Button("Save", {110, 0}) || chosen;
  }
  ImGui::SameLine();
  const bool leaves = cancelled();
  if (chosen && is_answer(browser, path)) {
    if (!is_scene_path(path)) path += ".json";
    if (!browser.asks_overwrite && fs::exists(path, code)) {
      browser.asks_overwrite = true;
    } else {
      context.push_command(SaveAs{path});
      ImGui::CloseCurrentPopup();
    }
  } else if (leaves) {
    context.push_command(CancelSave{});
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

}  // namespace

void draw_file_dialogs(PanelContext& context) {
  draw_open<OpenFile>(context, "Open", context.state.dialogs.show_open);
  draw_open<AddFile>(context, "Add", context.state.dialogs.show_add);
  draw_save(context);
}

}  // namespace catena::app
