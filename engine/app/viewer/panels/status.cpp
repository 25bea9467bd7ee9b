// SPDX-License-Identifier: MIT
// The status line at the bottom: the newest message or the point under the pointer, and the force on the device.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "engine/app/viewer/panels/panel.h"
#include "engine/base/clock.h"
#include "engine/base/console.h"

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
  const std::string now = activity();
  return "loading " + state.loading_path + " " + dots[static_cast<std::size_t>(now_ns() / 400'000'000 % 3)] + (now.empty() ? "" : " ") +
         now;
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

/// Draws a text in lines as wide as the window, whose lower edge is at `bottom`.
void draw_wrapped_text(const std::string& text, const ImVec4& color, float bottom) {
  const ImGuiViewport& view = *ImGui::GetMainViewport();
  ImGui::SetNextWindowPos({view.WorkPos.x, bottom}, 0, {0, 1});
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                      ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing;
  if (ImGui::Begin("##words", nullptr, kFlags)) {
    ImGui::PushTextWrapPos(view.WorkSize.x - 2 * ImGui::GetStyle().WindowPadding.x);
    ImGui::TextColored(color, "%s", text.c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::End();
}

/// With panels hidden, draws only the messages that must be read.
void draw_words_alone(const ViewState& state) {
  const ImGuiViewport& view = *ImGui::GetMainViewport();
  const float bottom = view.WorkPos.y + view.WorkSize.y;
  if (!state.loading_path.empty())
    draw_wrapped_text(loading_words(state), ImGui::GetStyleColorVec4(ImGuiCol_Text), bottom);
  else if (const Message* message = newest(state))
    draw_wrapped_text(message->text, color_of(*message), bottom);
}

/// Returns the beginning of a text that fits into a width, with "..." if it is not the whole text.
std::string elided(std::string text, float width) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  while (!text.empty() && ImGui::CalcTextSize((text + "...").c_str()).x > width) {
    const auto is_continuation = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; };
    while (text.size() > 1 && is_continuation(text.back())) text.pop_back();
    text.pop_back();
  }
  return text + "...";
}

/// Draws a line of the status; the whole text as a tooltip if it does not fit. Returns whether it fits.
bool draw_line(const std::string& text, const ImVec4& color) {
  const std::string line = elided(text, ImGui::GetContentRegionAvail().x);
  ImGui::TextColored(color, "%s", line.c_str());
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text.c_str());
  return line == text;
}

}  // namespace

void draw_status(PanelContext& context) {
  const ViewState& state = context.state;
  draw_prompt(context);
  if (!state.show_panels) return draw_words_alone(state);
  const ImGuiViewport& view = *ImGui::GetMainViewport();
  const float height = ImGui::GetFrameHeightWithSpacing();
  const Message* long_message = nullptr;  // one that does not fit into the line
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
    const ImVec4 plain = ImGui::GetStyleColorVec4(ImGuiCol_Text);
    if (!state.loading_path.empty()) {
      draw_line(loading_words(state), plain);
    } else if (const Message* m = newest(state)) {
      if (!draw_line(m->text, color_of(*m))) long_message = m;
    } else {
      std::string words = format_point_samples(state.pointer_samples, state.unit_length);
      if (words.empty() && context.navigation.probe_mode) words = "probe mode: the mouse moves the probe (H)";
      if (words.empty() && context.navigation.fly)
        words = fmt::format("fly: W S A D E Q, left drag turns the camera, speed {:.2g} (V)", context.navigation.fly_speed);
      draw_line(words, plain);
    }
  }
  ImGui::End();
  ImGui::PopStyleVar();
  if (long_message != nullptr) draw_wrapped_text(long_message->text, color_of(*long_message), view.WorkPos.y + view.WorkSize.y - height);
}

}  // namespace catena::app
