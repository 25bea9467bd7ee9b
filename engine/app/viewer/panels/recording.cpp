// SPDX-License-Identifier: MIT
// Panel of the recording: starts and stops writing every tick of the session to a file.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "engine/app/viewer/panels/panel.h"
#include "engine/app/viewer/panels/property_widgets.h"
#include "engine/app/viewer/scene/file_browser.h"

namespace catena::app {

namespace {

void draw_recording(PanelContext& context) {
  const Recording& recording = context.haptic_session.recording();
  static char name[1024] = "";
  if (!recording.is_recording()) {
    if (name[0] == 0) {
      const std::string& scene = context.scene.document().path();
      const std::string proposed = unused_file_name(std::filesystem::path(scene).parent_path().string(), path_stem(scene), ".catlog");
      std::strncpy(name, proposed.c_str(), sizeof name - 1);
    }
    ImGui::SetNextItemWidth(-1);
    const bool enter = ImGui::InputText("##file", name, sizeof name, ImGuiInputTextFlags_EnterReturnsTrue);
    show_tooltip("file of the recording (.catlog)");
    // an existing file is replaced only by a click on the button that says so, never by Enter
    std::error_code ignored;
    const bool exists = name[0] != 0 && std::filesystem::exists(name, ignored);
    const bool clicked = ImGui::Button(exists ? "Replace the file" : "Record");
    if (name[0] != 0 && (clicked || (enter && !exists))) context.push_command(SetRecording{name});
    show_tooltip(exists ? "the file exists: the recording replaces it"
                        : "record every tick, the scene and all edits; catena replay --log replays the recording");
    return;
  }
  // the Stop button takes the position of the Record button
  const haptics::log::LogStatus status = recording.status();
  ImGui::SetNextItemWidth(-1);
  std::string path = recording.path();
  ImGui::InputText("##file", path.data(), path.size() + 1, ImGuiInputTextFlags_ReadOnly);
  if (ImGui::Button("Stop")) {
    context.push_command(SetRecording{});
    name[0] = 0;
  }
  const int s = static_cast<int>(recording.seconds());
  ImGui::Text("%d:%02d  %llu ticks, %.1f MB", s / 60, s % 60, static_cast<unsigned long long>(status.ticks),
              1e-6 * static_cast<double>(status.bytes));
  if (status.lost > 0) ImGui::TextColored({1, 0.5f, 0.4f, 1}, "%llu ticks lost", static_cast<unsigned long long>(status.lost));
  if (status.failed) ImGui::TextColored({1, 0.5f, 0.4f, 1}, "the recording cannot be written");
}

}  // namespace

Panel recording_panel() { return {"Recording", false, draw_recording}; }

}  // namespace catena::app
