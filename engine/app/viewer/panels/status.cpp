// SPDX-License-Identifier: MIT
// The status line at the bottom: the newest message or the point under the pointer, and the force on the device.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "engine/app/viewer/panels/panel.h"
#include "engine/base/clock.h"

namespace catena::app {

namespace {

constexpr double kMessageS = 8;

const Message* newest(const ViewState& state) {
  if (state.messages.empty()) return nullptr;
  const Message& m = state.messages.back();
  return 1e-9 * static_cast<double>(now_ns() - m.time_ns) < kMessageS ? &m : nullptr;
}

ImVec4 color_of(const Message& m) { return m.is_error ? ImVec4(1, 0.5f, 0.4f, 1) : ImVec4(0.7f, 0.9f, 0.7f, 1); }

/// Color from neutral to red as the force approaches its limit; `share`: force divided by the limit.
ImVec4 force_color(double share) {
  const auto s = static_cast<float>(share);
  return {0.35f + 0.6f * s, 0.75f - 0.5f * s, 0.9f - 0.7f * s, 1};
}

std::string loading_words(const ViewState& state) {
  const char* dots[] = {".  ", ".. ", "..."};
  return "loading " + state.loading_path + " " + dots[static_cast<std::size_t>(now_ns() / 400'000'000 % 3)];
}

void draw_force(const PanelContext& context) {
  const ViewState& state = context.state;
  ImGui::PushStyleColor(ImGuiCol_PlotHistogram, force_color(state.force_ratio));
  const std::string newtons = fmt::format("{:.2f} N", norm(context.haptic_session.latest_state().force_n));
  ImGui::ProgressBar(static_cast<float>(state.force_ratio), {110, ImGui::GetTextLineHeight()}, newtons.c_str());
  ImGui::PopStyleColor();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("force on the hand; the maximum is %.3g N", context.scene.scene().coupling.max_force_n);
}

/// Status text such as "skin 5.1 mm": the last link in contact and the distance of the probe from it, in device millimeters.
std::string held_words(const PanelContext& context) {
  const HapticState& haptic_state = context.haptic_session.latest_state();
  const auto& program = context.haptic_session.program();
  for (int i = haptic_state.link_count - 1; i >= 0; --i) {
    const LinkReport& link = haptic_state.links[static_cast<std::size_t>(i)];
    if (link.active && link.gap > 0 && static_cast<std::size_t>(i) < context.haptic_session.link_names().size())
      return fmt::format("{} {:.1f} mm", context.haptic_session.link_names()[static_cast<std::size_t>(i)],
                         1e3 * program->meters_per_unit * link.gap);
  }
  return {};
}

/// Draws the instruction for the user in the middle of the image.
void draw_prompt(PanelContext& context) {
  const ViewState& state = context.state;
  if (state.prompt.empty()) return;
  const Area& area = state.image_area;
  ImGui::SetNextWindowPos({float(area.x + 0.5 * area.width), float(area.y + 0.5 * area.height)}, 0, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({float(std::min(0.9 * area.width, 30.0 * ImGui::GetFontSize())), 0});
  constexpr ImGuiWindowFlags kFlags =
      ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing;
  if (ImGui::Begin("##prompt", nullptr, kFlags)) {
    ImGui::TextWrapped("%s", state.prompt.c_str());
    if (const Message* message = newest(state); message && message->text != state.prompt) {
      ImGui::PushStyleColor(ImGuiCol_Text, color_of(*message));
      ImGui::TextWrapped("%s", message->text.c_str());
      ImGui::PopStyleColor();
    }
    if (ImGui::Button("Cancel (G)")) context.push_command(Action::register_device);
  }
  ImGui::End();
}

/// With panels hidden, draws only the messages that must be read.
void draw_words_alone(const ViewState& state) {
  const Message* message = newest(state);
  if (message == nullptr && state.loading_path.empty()) return;
  const ImGuiViewport& view = *ImGui::GetMainViewport();
  ImGui::SetNextWindowPos({view.WorkPos.x, view.WorkPos.y + view.WorkSize.y}, 0, {0, 1});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {view.WorkSize.x, view.WorkSize.y});
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                      ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing;
  if (ImGui::Begin("##words", nullptr, kFlags)) {
    if (!state.loading_path.empty())
      ImGui::TextUnformatted(loading_words(state).c_str());
    else
      ImGui::TextColored(color_of(*message), "%s", message->text.c_str());
  }
  ImGui::End();
}

}  // namespace

void draw_status(PanelContext& context) {
  const ViewState& state = context.state;
  draw_prompt(context);
  if (!state.show_panels) return draw_words_alone(state);
  const ImGuiViewport& view = *ImGui::GetMainViewport();
  const float height = ImGui::GetFrameHeightWithSpacing();
  ImGui::SetNextWindowPos({view.WorkPos.x, view.WorkPos.y + view.WorkSize.y - height});
  ImGui::SetNextWindowSize({view.WorkSize.x, height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8, 3});
  if (ImGui::Begin("##status", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings)) {
    draw_force(context);
    ImGui::SameLine();
    if (const std::string held = held_words(context); !held.empty()) {
      ImGui::TextUnformatted(held.c_str());
      ImGui::SameLine();
    }
    if (!state.loading_path.empty()) {
      ImGui::TextUnformatted(loading_words(state).c_str());
    } else if (const Message* m = newest(state)) {
      ImGui::TextColored(color_of(*m), "%s", m->text.c_str());
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", m->text.c_str());
    } else {
      std::string words = format_point_samples(state.pointer_samples, state.unit_length);
      if (words.empty() && context.navigation.probe_mode) words = "probe mode: the mouse moves the probe (H)";
      if (words.empty() && context.navigation.fly)
        words = fmt::format("fly: W S A D E Q, left drag turns the camera, speed {:.2g} (V)", context.navigation.fly_speed);
      ImGui::TextUnformatted(words.c_str());
    }
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace catena::app
