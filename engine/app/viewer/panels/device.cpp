// SPDX-License-Identifier: MIT
// Panel of the device: the device that moves the probe, the state of its servo, and the other available devices.
#include <fmt/format.h>
#include <imgui.h>

#include "engine/app/haptics/haptic_device_setup.h"
#include "engine/app/viewer/panels/panel.h"
#include "engine/app/viewer/panels/property_widgets.h"

namespace catena::app {

namespace {

void draw_choice(PanelContext& context) {
  static std::vector<haptics::DeviceInfo> found;  // the bus is scanned when the list opens, not in every frame
  const std::string& now = context.haptic_session.device_name();
  if (ImGui::BeginCombo("##device", now.c_str(), ImGuiComboFlags_HeightLarge)) {
    if (ImGui::IsWindowAppearing()) found = haptics::list_devices();
    for (const haptics::DeviceInfo& info : found) {
      if (info.name.find(".csv") != std::string::npos) continue;  // needs a file name: option --device
      // the mouse is always present
      const bool present = info.available || info.name == "mouse";
      if (ImGui::Selectable(info.name.c_str(), info.name == now, present ? 0 : ImGuiSelectableFlags_Disabled))
        context.push_command(SelectDevice{info.name});
      if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", info.detail.c_str());
    }
    ImGui::EndCombo();
  }
  show_tooltip("device that moves the probe; opening the list scans for connected devices. Forces of a newly chosen device are off");
}

void draw_capabilities(const haptics::DeviceCapabilities& c) {
  ImGui::Text("%s", c.name.c_str());
  std::string text = fmt::format("{:.3g} cm, {} button{}", 100 * c.workspace_m, c.button_count, c.button_count == 1 ? "" : "s");
  text += c.max_force_n > 0 ? fmt::format(", {:.3g} N", c.max_force_n) : ", no force";
  if (c.has_orientation) text += c.max_torque_nm > 0 ? fmt::format(", 6-DOF, {:.2g} N m", c.max_torque_nm) : ", 6-DOF";
  ImGui::TextDisabled("%s", text.c_str());
  show_tooltip("edge length of the workspace, number of buttons, maximum force; 6-DOF: the device reports its orientation");
}

void draw_buttons(std::uint32_t pressed, int count) {
  ImGui::TextUnformatted("Buttons");
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float r = 0.32f * ImGui::GetFontSize();
  for (int b = 0; b < std::min(count, 8); ++b) {
    ImGui::SameLine();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool on = (pressed >> b & 1u) != 0;
    list.AddCircleFilled({at.x + r, at.y + 0.5f * ImGui::GetTextLineHeight()}, r,
                         on ? IM_COL32(120, 230, 120, 255) : IM_COL32(70, 70, 75, 255));
    ImGui::Dummy({2.5f * r, ImGui::GetTextLineHeight()});
  }
}

void draw_device(PanelContext& context) {
  HapticSession& hand = context.haptic_session;
  const haptics::DeviceCapabilities& c = hand.device().device->capabilities();
  const HapticState& haptic_state = hand.latest_state();
  draw_choice(context);
  draw_capabilities(c);
  if (const std::string text = hand.device().device->status_text(); !text.empty()) ImGui::TextWrapped("%s", text.c_str());
  if (!hand.open_notice().empty()) ImGui::TextWrapped("%s", hand.open_notice().c_str());

  if (!hand.is_mouse() && c.max_force_n > 0) {
    bool on = hand.forces_enabled();
    if (ImGui::Checkbox("Forces (F)", &on)) context.push_command(Action::toggle_forces);
    show_tooltip("switches the forces of the device on or off; they act at once");
  }
  if (haptics::is_stationary(haptics::parse_device_type(hand.device_name()))) {
    if (ImGui::Button("Register in the room (G)")) context.push_command(Action::register_device);
    show_tooltip(hand.room() ? "the device is registered in the headset's room; touch three points to register it anew"
                             : "with a headset: touch three points to register the position of the device in the room");
  }
  const Vec3 at = device_from_world(context.scene.scene().workspace, haptic_state.probe);
  ImGui::Text("Probe %.1f %.1f %.1f mm", 1e3 * at.x, 1e3 * at.y, 1e3 * at.z);
  show_tooltip("position of the probe in device coordinates");
  ImGui::Text("Force %.2f N  (%.2f %.2f %.2f)", norm(haptic_state.force_n), haptic_state.force_n.x, haptic_state.force_n.y,
              haptic_state.force_n.z);
  show_tooltip("force on the hand: magnitude, and components in world axes");
  ImGui::SameLine();
  ImGui::TextDisabled("%s", to_string(haptic_state.force_state));
  draw_buttons(haptic_state.buttons, c.button_count);

  ImGui::Separator();
  const haptics::ServoStats servo = hand.servo().stats();
  ImGui::Text("%.0f Hz, %.0f us median", servo.rate_hz, servo.compute.p50_us);
  show_tooltip("ticks per second; median compute time of a tick");
  ImGui::Text("%llu deadlines missed, %llu watchdog trips", static_cast<unsigned long long>(servo.missed_deadlines),
              static_cast<unsigned long long>(servo.watchdog_trips));
  if (haptic_state.condition != TickCondition::normal) ImGui::TextColored({1, 0.7f, 0.35f, 1}, "%s", to_string(haptic_state.condition));
  const haptics::RealtimeReport& r = servo.realtime;
  ImGui::TextDisabled("%s priority, memory %s, %s", r.fifo ? "fixed" : "normal", r.locked ? "locked" : "not locked",
                      r.cpu >= 0 ? fmt::format("core {}", r.cpu).c_str() : "any core");
  for (const std::string& note : r.notes) ImGui::TextWrapped("%s", note.c_str());
}

}  // namespace

Panel device_panel() { return {"Device", false, draw_device}; }

}  // namespace catena::app
