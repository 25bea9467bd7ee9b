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
  show_tooltip("what holds the probe; a click looks at what is plugged in. Its forces are off at first");
}

void draw_capabilities(const haptics::DeviceCapabilities& c) {
  ImGui::Text("%s", c.name.c_str());
  std::string text = fmt::format("{:.3g} cm, {} button{}", 100 * c.workspace_m, c.button_count, c.button_count == 1 ? "" : "s");
  text += c.max_force_n > 0 ? fmt::format(", {:.3g} N", c.max_force_n) : ", no force";
  if (c.has_orientation) text += c.max_torque_nm > 0 ? fmt::format(", turns, {:.2g} N m", c.max_torque_nm) : ", turns";
  ImGui::TextDisabled("%s", text.c_str());
  show_tooltip("edge of the cube that the hand reaches, buttons, the maximum force");
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
  const HapticState& felt = hand.latest_state();
  draw_choice(context);
  draw_capabilities(c);
  if (const std::string text = hand.device().device->status_text(); !text.empty()) ImGui::TextWrapped("%s", text.c_str());
  if (!hand.open_notice().empty()) ImGui::TextWrapped("%s", hand.open_notice().c_str());

  if (!hand.is_mouse() && c.max_force_n > 0) {
    bool on = hand.forces_enabled();
    if (ImGui::Checkbox("Forces (F)", &on)) context.push_command(Action::toggle_forces);
    show_tooltip("the device may push; what a force does is felt at once");
  }
  if (haptics::is_stationary(haptics::parse_device_type(hand.device_name()))) {
    if (ImGui::Button("Register in the room (G)")) context.push_command(Action::register_device);
    show_tooltip(hand.room() ? "where it stands in the headset's room is known; touch three places again"
                             : "with a headset: touch three places, which says where it stands");
  }
  const Vec3 at = device_from_world(context.scene.scene().workspace, felt.probe);
  ImGui::Text("At %.1f %.1f %.1f mm", 1e3 * at.x, 1e3 * at.y, 1e3 * at.z);
  show_tooltip("the probe in the device's own axes");
  ImGui::Text("Force %.2f N  (%.2f %.2f %.2f)", norm(felt.force_n), felt.force_n.x, felt.force_n.y, felt.force_n.z);
  show_tooltip("on the hand now, world axes");
  ImGui::SameLine();
  ImGui::TextDisabled("%s", to_string(felt.force_state));
  draw_buttons(felt.buttons, c.button_count);

  ImGui::Separator();
  const haptics::ServoStats servo = hand.servo().stats();
  ImGui::Text("%.0f Hz, %.0f us median", servo.rate_hz, servo.compute.p50_us);
  show_tooltip("ticks a second; what one takes");
  ImGui::Text("%llu deadlines missed, %llu watchdog trips", static_cast<unsigned long long>(servo.missed_deadlines),
              static_cast<unsigned long long>(servo.watchdog_trips));
  if (felt.condition != TickCondition::normal) ImGui::TextColored({1, 0.7f, 0.35f, 1}, "%s", to_string(felt.condition));
  const haptics::RealtimeReport& r = servo.realtime;
  ImGui::TextDisabled("%s priority, memory %s, %s", r.fifo ? "fixed" : "normal", r.locked ? "locked" : "not locked",
                      r.cpu >= 0 ? fmt::format("core {}", r.cpu).c_str() : "any core");
  for (const std::string& note : r.notes) ImGui::TextWrapped("%s", note.c_str());
}

}  // namespace

Panel device_panel() { return {"Device", false, draw_device}; }

}  // namespace catena::app
