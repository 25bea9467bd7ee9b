// SPDX-License-Identifier: MIT
#include "engine/app/viewer/panels/property_widgets.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "engine/app/viewer/edit/haptic_binding.h"
#include "engine/app/viewer/edit/histogram_cache.h"
#include "engine/scene/to_json.h"

namespace catena::app {

namespace {

/// The key that an item edits, as the undo label.
std::string key_of(const std::string& pointer) { return pointer.substr(pointer.rfind('/') + 1); }

/// Returns whether `now` is final. False while digits are typed: a surface that follows each digit would jump under the probe.
bool is_settled(EditState& state, const std::string& pointer, bool changed, const Vec3& before, Vec3& now) {
  // a click that types a number forms an undo group of its own
  if (ImGui::IsItemActivated()) ++state.gesture;
  TypedInput& typed = state.typed;
  const int frame = ImGui::GetFrameCount();
  const bool mine = typed.pointer == pointer && typed.last_typed_frame >= frame - 1;
  if (ImGui::IsItemActive() && ImGui::GetIO().WantTextInput) {
    if (!changed && !mine) return false;
    typed = {pointer, changed ? now : typed.values, frame};
    return false;
  }
  if (mine && !changed) now = typed.values;
  if (mine) typed = {};
  return (mine || changed) && is_finite(now) && now != before;
}

float speed_of(double speed, double value) { return static_cast<float>(speed > 0 ? speed : std::max(1e-6, 0.005 * std::abs(value))); }

}  // namespace

bool begin_item(Edits& edits, const json::Node& where, bool visible, const std::string& word, const std::string& name) {
  const std::string pointer = item_pointer(where);
  ImGui::PushID(pointer.empty() ? name.c_str() : pointer.c_str());
  const float button = ImGui::GetFrameHeight();
  bool open = false;
  if (pointer.empty()) {
    ImGui::TextDisabled("%s: save the scene first", name.c_str());
  } else {
    bool seen = visible;
    if (ImGui::Checkbox("##seen", &seen)) edits.set(pointer + "/visible", scene::to_json(seen), seen ? "show " + word : "hide " + word);
    show_short_tooltip(visible ? "hide the item" : "show the item");
    ImGui::SameLine();
    if (!visible) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    open = ImGui::TreeNodeEx("##open", ImGuiTreeNodeFlags_DefaultOpen | ImGuiTreeNodeFlags_AllowItemOverlap, "%s", name.c_str());
    if (!visible) ImGui::PopStyleColor();
    if (can_bind_haptics(where.label.substr(0, where.label.find('[')))) {
      const float width = ImGui::CalcTextSize("Feel").x + 2 * ImGui::GetStyle().FramePadding.x;
      ImGui::SameLine(ImGui::GetContentRegionMax().x - button - width - ImGui::GetStyle().ItemSpacing.x);
      if (ImGui::Button("Feel", {width, 0})) edits.bind_haptics(where.label);
      show_short_tooltip("add a link to the chain that lies on this object and follows the object's changes");
    }
    ImGui::SameLine(ImGui::GetContentRegionMax().x - button);
    if (ImGui::Button("x", {button, 0})) edits.remove_item(where.label, "remove " + word);
    show_short_tooltip("remove the item from the scene");
  }
  if (!open) ImGui::PopID();
  return open;
}

void end_item() {
  ImGui::TreePop();
  ImGui::PopID();
}

void edit_boolean(Edits& edits, const char* label, bool value, const std::string& pointer) {
  if (ImGui::Checkbox(label, &value)) edits.set(pointer, scene::to_json(value), label);
}

void edit_slider(Edits& edits, const char* label, double value, double lo, double hi, const std::string& pointer, const char* format) {
  auto now = static_cast<float>(value);
  if (ImGui::SliderFloat(label, &now, static_cast<float>(lo), static_cast<float>(hi), format, ImGuiSliderFlags_AlwaysClamp))
    edits.drag(pointer, scene::to_json(round_within(now, lo, hi, 1000)), label);
}

void edit_color(Edits& edits, const char* label, const Color& color, const std::string& pointer) {
  float rgb[3] = {color.r, color.g, color.b};
  if (ImGui::ColorEdit3(label, rgb, ImGuiColorEditFlags_NoInputs))
    edits.drag(pointer, scene::to_json(Color{rgb[0], rgb[1], rgb[2]}), label[0] == '#' ? "colour" : label);
}

namespace {

/// The value that the item states, or else the default.
json::Node value_of(const json::Node& item, const schema::Key& key) {
  if (const json::Node* stated = item.find(key.name)) return *stated;
  auto usual = json::parse(key.default_text, key.name);
  return usual ? *usual : json::Node();
}

bool is_plain(const schema::Key& key) {
  using schema::ValueType;
  return key.value_type == ValueType::boolean || key.value_type == ValueType::choice ||
         (key.value_type == ValueType::number && key.limits.lo && key.limits.hi);
}

void edit_plain_key(Edits& edits, const schema::Key& key, const json::Node& value, const std::string& pointer) {
  const std::string label = key.name == "clip" ? "clipped by the clip planes" : key.name;
  if (key.value_type == schema::ValueType::boolean && value.kind == json::Kind::boolean) {
    edit_boolean(edits, label.c_str(), value.boolean, pointer);
  } else if (key.value_type == schema::ValueType::number && value.kind == json::Kind::number) {
    edit_slider(edits, label.c_str(), value.number, *key.limits.lo, *key.limits.hi, pointer, "%.2f");
  } else if (key.value_type == schema::ValueType::choice && value.kind == json::Kind::string) {
    std::string chosen = value.string;
    if (choose_from_list(label.c_str(), key.options, chosen)) edits.set(pointer, scene::to_json(chosen), label);
  } else {
    return;
  }
  show_short_tooltip(key.help);
}

}  // namespace

void edit_simple_keys(Edits& edits, const std::string& part, const json::Node& item, const std::vector<std::string_view>& but) {
  for (const schema::Section& component : scene::scene_components()) {
    if (component.name != part) continue;
    for (const schema::Key& key : component.keys)
      if (is_plain(key) && key.name != "visible" && std::find(but.begin(), but.end(), key.name) == but.end())
        edit_plain_key(edits, key, value_of(item, key), item_pointer(item) + "/" + key.name);
  }
}

void edit_number(Edits& edits, const NumberItem& item) {
  double value = item.value;
  const bool ranged = item.lo < item.hi;
  const bool changed = ImGui::DragScalar(item.label, ImGuiDataType_Double, &value, speed_of(item.speed, item.value),
                                         ranged ? &item.lo : nullptr, ranged ? &item.hi : nullptr, item.format);
  Vec3 now(value, 0, 0);
  if (!is_settled(edits.state(), item.pointer, changed, Vec3(item.value, 0, 0), now)) return;
  TextEdits change{{item.pointer, scene::to_json(now.x)}};
  for (const std::string& pointer : item.coupled_pointers) change.push_back({pointer, scene::to_json(now.x)});
  edits.drag(change, key_of(item.pointer));
}

void edit_vector(Edits& edits, const char* label, const std::string& pointer, const Vec3& value, double speed) {
  double numbers[3] = {value.x, value.y, value.z};
  const bool changed =
      ImGui::DragScalarN(label, ImGuiDataType_Double, numbers, 3, speed_of(speed, max_abs(value)), nullptr, nullptr, "%.4g");
  Vec3 now(numbers[0], numbers[1], numbers[2]);
  if (is_settled(edits.state(), pointer, changed, value, now)) edits.drag(pointer, scene::to_json(now), key_of(pointer));
}

bool input_number(const char* label, double& value, const char* hint) {
  double typed = value;
  const bool entered = ImGui::InputDouble(label, &typed, 0, 0, "%.6g", ImGuiInputTextFlags_EnterReturnsTrue);
  show_short_tooltip(hint);
  if (!entered || !std::isfinite(typed) || typed == value) return false;
  value = typed;
  return true;
}

bool choose_from_list(const char* label, const std::vector<std::string>& words, std::string& chosen) {
  const std::string before = chosen;
  if (!ImGui::BeginCombo(label, chosen.c_str())) return false;
  for (const std::string& word : words)
    if (ImGui::Selectable(word.c_str(), word == chosen)) chosen = word;
  ImGui::EndCombo();
  return chosen != before;
}

void show_tooltip(const std::string& text) {
  if (!ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(22 * ImGui::GetFontSize());
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

void show_short_tooltip(const std::string& text) {
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text.c_str());
}

}  // namespace catena::app
