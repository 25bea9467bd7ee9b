// The line at the bottom: the newest message, or what the hand feels.
#include <fmt/format.h>
#include <imgui.h>

#include "engine/app/viewer/panel.h"
#include "engine/base/clock.h"

namespace catena::app {

namespace {
constexpr double kMessageS = 8;
}

void draw_status(PanelContext& context) {
  const ImGuiViewport& view = *ImGui::GetMainViewport();
  const float height = ImGui::GetFrameHeightWithSpacing();
  ImGui::SetNextWindowPos({view.WorkPos.x, view.WorkPos.y + view.WorkSize.y - height});
  ImGui::SetNextWindowSize({view.WorkSize.x, height});
  if (ImGui::Begin("##status", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings)) {
    const auto& messages = context.state.messages;
    if (!messages.empty() && 1e-9 * static_cast<double>(now_ns() - messages.back().at_ns) < kMessageS) {
      const Message& m = messages.back();
      ImGui::TextColored(m.is_error ? ImVec4(1, 0.5f, 0.4f, 1) : ImVec4(0.7f, 0.9f, 0.7f, 1), "%s", m.text.c_str());
    } else {
      ImGui::TextUnformatted(fmt::format("{:.2f} N", norm(context.hand.felt().force_n)).c_str());
    }
  }
  ImGui::End();
}

}  // namespace catena::app
