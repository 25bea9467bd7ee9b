#include "engine/app/viewer/panels/look_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/scene/color_maps.h"

namespace catena::app {

namespace {

constexpr float kBarsHeight = 44;
constexpr double kFine = 0.1;

std::string key_of(const PanelContext& context, const std::string& what) { return fmt::format("{} {}", what, context.state.look.press); }

}  // namespace

Edits::~Edits() {
  for (const auto& action : actions_) action(context_);
}

void Edits::set(std::string pointer, std::string value, std::string what) {
  later([=](PanelContext& context) { context.edit(pointer, value, what); });
}

void Edits::drag(std::string pointer, std::string value, std::string what) {
  drag(TextEdits{{std::move(pointer), std::move(value)}}, what);
}

void Edits::set(const TextEdits& edits, const std::string& what) {
  later([=](PanelContext& context) { context.apply(edits, what); });
}

void Edits::drag(const TextEdits& edits, const std::string& what) {
  later([=](PanelContext& context) { context.apply(edits, what, key_of(context, what)); });
}

void Edits::remove(std::string pointer, std::string what) {
  later([=](PanelContext& context) { context.remove(pointer, what); });
}

void tip(const char* text) {
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

bool begin_item(Edits& edits, const json::Node& where, bool visible, const std::string& word, const std::string& name) {
  const std::string pointer = pointer_of(where);
  ImGui::PushID(pointer.empty() ? name.c_str() : pointer.c_str());
  const float button = ImGui::GetFrameHeight();
  bool open = false;
  if (pointer.empty()) {
    ImGui::TextDisabled("%s: save the scene first", name.c_str());
  } else {
    bool seen = visible;
    if (ImGui::Checkbox("##seen", &seen)) edits.set(pointer + "/visible", scene::text_of(seen), seen ? "show " + word : "hide " + word);
    tip(visible ? "seen" : "hidden");
    ImGui::SameLine();
    if (!visible) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    open = ImGui::TreeNodeEx("##open", ImGuiTreeNodeFlags_DefaultOpen | ImGuiTreeNodeFlags_AllowItemOverlap, "%s", name.c_str());
    if (!visible) ImGui::PopStyleColor();
    ImGui::SameLine(ImGui::GetContentRegionMax().x - button);
    if (ImGui::Button("x", {button, 0})) edits.remove(pointer, "remove " + word);
    tip("remove");
  }
  if (!open) ImGui::PopID();
  return open;
}

void end_item() {
  ImGui::TreePop();
  ImGui::PopID();
}

void edit_boolean(Edits& edits, const char* label, bool value, const std::string& pointer) {
  if (ImGui::Checkbox(label, &value)) edits.set(pointer, scene::text_of(value), label);
}

void edit_share(Edits& edits, const char* label, double value, const std::string& pointer) {
  auto share = static_cast<float>(value);
  if (ImGui::SliderFloat(label, &share, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp))
    edits.drag(pointer, scene::text_of(rounded_in(share, 0, 1, 1000)), label);
}

void edit_color(Edits& edits, const char* label, const scene::Rgb& color, const std::string& pointer) {
  float rgb[3] = {color.r, color.g, color.b};
  if (ImGui::ColorEdit3(label, rgb, ImGuiColorEditFlags_NoInputs))
    edits.drag(pointer, scene::text_of(scene::Rgb{rgb[0], rgb[1], rgb[2]}), label[0] == '#' ? "colour" : label);
}

bool typed_number(const char* label, double& value, const char* hint) {
  double typed = value;
  const bool entered = ImGui::InputDouble(label, &typed, 0, 0, "%.6g", ImGuiInputTextFlags_EnterReturnsTrue);
  tip(hint);
  if (!entered || !std::isfinite(typed) || typed == value) return false;
  value = typed;
  return true;
}

std::optional<std::string> choose_map(const std::string& now, const char* otherwise) {
  const bool reversed = now.ends_with("_r");
  const std::string base = reversed ? now.substr(0, now.size() - 2) : now;
  std::optional<std::string> chosen;
  ImGui::SetNextItemWidth(0.5f * ImGui::GetContentRegionAvail().x);
  if (ImGui::BeginCombo("##map", now.empty() ? otherwise : base.c_str())) {
    for (const std::string_view name : scene::color_map_names()) {
      const std::string word(name);
      const ImVec2 at = ImGui::GetCursorScreenPos();
      if (ImGui::Selectable(("##" + word).c_str(), word == base)) chosen = word + (reversed ? "_r" : "");
      // the map itself beside its name
      const float height = ImGui::GetTextLineHeight();
      ImDrawList* list = ImGui::GetWindowDrawList();
      const auto points = scene::named_map(name, 0, 1);
      for (int i = 0; i < 24; ++i)
        list->AddRectFilled({at.x + 2 * static_cast<float>(i), at.y}, {at.x + 2 * static_cast<float>(i + 1), at.y + height},
                            packed(color_at(points, i / 23.0)));
      list->AddText({at.x + 56, at.y}, ImGui::GetColorU32(ImGuiCol_Text), word.c_str());
    }
    ImGui::EndCombo();
  }
  ImGui::SameLine();
  bool turned = reversed;
  ImGui::BeginDisabled(now.empty());
  if (ImGui::Checkbox("reversed", &turned) && !now.empty()) chosen = base + (turned ? "_r" : "");
  ImGui::EndDisabled();
  return chosen;
}

void edit_color_scale(Edits& edits, const json::Node& item, const std::vector<scene::TransferFunction::ColorPoint>& table,
                      const scene::NamedColors& named, std::string_view fallback) {
  const std::string pointer = pointer_of(item);
  const bool file = item.find("transfer") != nullptr;
  ImGui::PushID("scale");
  if (const auto map = choose_map(table.empty() && named.map.empty() ? std::string(fallback) : named.map, file ? "of a file" : "a table")) {
    TextEdits change{{pointer + "/color", scene::text_of(*map)}};
    if (file) change.insert(change.begin(), {{pointer + "/transfer", std::nullopt}, {pointer + "/range", std::nullopt}});
    edits.set(change, "colours");
  }
  if (table.empty() && !file) {
    bool own = named.range.has_value();
    if (named.range) {
      std::array<double, 2> range = *named.range;
      ImGui::SetNextItemWidth(0.32f * ImGui::GetContentRegionAvail().x);
      bool typed = typed_number("##from", range[0], "value at the first colour");
      ImGui::SameLine();
      ImGui::SetNextItemWidth(0.45f * ImGui::GetContentRegionAvail().x);
      typed = typed_number("range", range[1], "value at the last colour") || typed;
      if (typed) edits.set(pointer + "/range", scene::text_of(range), "range");
      ImGui::SameLine();
      if (ImGui::Checkbox("##own", &own)) edits.remove(pointer + "/range", "range");
      tip("off: the range of the values");
    } else if (ImGui::Checkbox("own range", &own)) {
      edits.set(pointer + "/range", "[0, 1]", "range");
    }
  }
  ImGui::PopID();
}

void draw_bars(const PlotFrame& frame, const SortedValues& values, ImU32 color) {
  if (!values) return;
  const int bars = std::clamp(static_cast<int>((frame.right - frame.left) / 2), 1, 400);
  const std::vector<float> heights = histogram_bars(*values, frame.lo, frame.hi, bars);
  ImDrawList* list = ImGui::GetWindowDrawList();
  const double width = (frame.right - frame.left) / bars;
  for (int i = 0; i < bars; ++i) {
    const double top = frame.bottom - 0.95 * heights[static_cast<std::size_t>(i)] * (frame.bottom - frame.top);
    if (top >= frame.bottom) continue;
    list->AddRectFilled({static_cast<float>(frame.left + i * width), static_cast<float>(top)},
                        {static_cast<float>(frame.left + (i + 1) * width), static_cast<float>(frame.bottom)}, color);
  }
}

bool histogram_slider(PanelContext& context, const char* id, const SortedValues& values, double lo, double hi, const scene::Rgb& color,
                      double& value) {
  const auto range = plot_range(lo, hi);
  const ImVec2 at = ImGui::GetCursorScreenPos(), size{ImGui::GetContentRegionAvail().x, kBarsHeight};
  ImGui::InvisibleButton(id, size);
  const PlotFrame frame{at.x, at.y, at.x + size.x, at.y + size.y, range[0], range[1]};
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(at, {at.x + size.x, at.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg), 3);
  draw_bars(frame, values, ImGui::GetColorU32(ImGuiCol_Text, 0.35f));

  // from where the pointer went down; with Ctrl a tenth of the way
  LookState& look = context.state.look;
  bool moved = false;
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemActivated()) {
    look.at_x = io.MousePos.x;
    moved = true;
  } else if (ImGui::IsItemActive() && io.MouseDelta.x != 0) {
    look.at_x += io.MouseDelta.x * (io.KeyCtrl ? kFine : 1);
    moved = true;
  }
  const double before = value;
  if (moved && std::isfinite(lo) && std::isfinite(hi))
    value = std::clamp(rounded_in(frame.value_at(look.at_x), range[0], range[1], io.KeyCtrl ? 20000 : 2000), lo, hi);
  const auto x = static_cast<float>(std::clamp(frame.x_of(value), frame.left, frame.right));
  list->AddLine({x, at.y}, {x, at.y + size.y}, ImGui::GetColorU32(ImVec4(0, 0, 0, 0.8f)), 5);
  list->AddLine({x, at.y}, {x, at.y + size.y}, packed(color), 3);
  if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) ImGui::SetTooltip("%.6g .. %.6g\nCtrl: finely", lo, hi);
  return value != before;
}

}  // namespace catena::app
