#include "engine/app/viewer/panels/edit_items.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "engine/scene/write_values.h"

namespace catena::app {

namespace {

/// The name of the drag that the last item is in; a click that types a number is a drag of its own.
std::string drag_name(ViewState& state) {
  if (ImGui::IsItemActivated()) ++state.next_drag;
  return "drag " + std::to_string(state.next_drag);
}

/// True: `now` is to be taken. While digits are typed nothing is: a surface that follows each of them would jump under the hand.
bool is_settled(ViewState& state, const std::string& pointer, bool changed, const Vec3& before, Vec3& now) {
  TypedNumbers& typed = state.typed;
  const int frame = ImGui::GetFrameCount();
  const bool mine = typed.pointer == pointer && typed.frame >= frame - 1;
  if (ImGui::IsItemActive() && ImGui::GetIO().WantTextInput) {
    if (!changed && !mine) return false;
    typed = {pointer, changed ? now : typed.numbers, frame};
    return false;
  }
  if (mine && !changed) now = typed.numbers;
  if (mine) typed = {};
  return (mine || changed) && is_finite(now) && now != before;
}

float speed_of(double speed, double value) { return static_cast<float>(speed > 0 ? speed : std::max(1e-6, 0.005 * std::abs(value))); }

}  // namespace

bool edit_number(PanelContext& context, const NumberItem& item) {
  double value = item.value;
  const bool ranged = item.lo < item.hi;
  const bool changed = ImGui::DragScalar(item.label, ImGuiDataType_Double, &value, speed_of(item.speed, item.value),
                                         ranged ? &item.lo : nullptr, ranged ? &item.hi : nullptr, item.format);
  const std::string drag = drag_name(context.state);
  Vec3 now(value, 0, 0);
  if (!is_settled(context.state, item.pointer, changed, Vec3(item.value, 0, 0), now)) return false;
  std::vector<scene::Document::Edit> edits{{item.pointer, scene::text_of(now.x)}};
  for (const std::string& pointer : item.along) edits.push_back({pointer, scene::text_of(now.x)});
  return context.apply(edits, item.pointer.substr(item.pointer.rfind('/') + 1), drag);
}

bool edit_vector(PanelContext& context, const char* label, const std::string& pointer, const Vec3& value, double speed) {
  double numbers[3] = {value.x, value.y, value.z};
  const bool changed =
      ImGui::DragScalarN(label, ImGuiDataType_Double, numbers, 3, speed_of(speed, max_abs(value)), nullptr, nullptr, "%.4g");
  const std::string drag = drag_name(context.state);
  Vec3 now(numbers[0], numbers[1], numbers[2]);
  return is_settled(context.state, pointer, changed, value, now) &&
         context.edit(pointer, scene::text_of(now), pointer.substr(pointer.rfind('/') + 1), drag);
}

bool choose(const char* label, const std::vector<std::string>& words, std::string& chosen) {
  const std::string before = chosen;
  if (!ImGui::BeginCombo(label, chosen.c_str())) return false;
  for (const std::string& word : words)
    if (ImGui::Selectable(word.c_str(), word == chosen)) chosen = word;
  ImGui::EndCombo();
  return chosen != before;
}

void tip(const std::string& text) {
  if (!ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(22 * ImGui::GetFontSize());
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

}  // namespace catena::app
