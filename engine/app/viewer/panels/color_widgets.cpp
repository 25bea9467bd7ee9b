// SPDX-License-Identifier: MIT
#include "engine/app/viewer/panels/color_widgets.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "engine/field/field_display_range.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/labels.h"

namespace catena::app {

namespace {

constexpr float kBarsHeight = 44;
constexpr double kFine = 0.1;

}  // namespace

std::optional<std::string> choose_color_map(const std::string& now, const char* otherwise) {
  const bool reversed = now.ends_with("_r");
  const std::string base = reversed ? now.substr(0, now.size() - 2) : now;
  std::optional<std::string> chosen;
  constexpr float kListWidth = 180, kMaxListHeight = 420;  // the longest name beside its preview
  ImGui::SetNextItemWidth(0.42f * ImGui::GetContentRegionAvail().x);
  ImGui::SetNextWindowSizeConstraints({kListWidth, 0}, {FLT_MAX, kMaxListHeight});
  if (ImGui::BeginCombo("##map", now.empty() ? otherwise : base.c_str())) {
    for (const std::string_view name : scene::color_map_names()) {
      const std::string word(name);
      const ImVec2 at = ImGui::GetCursorScreenPos();
      if (ImGui::Selectable(("##" + word).c_str(), word == base)) chosen = word + (reversed ? "_r" : "");
      // a preview of the color map next to its name
      const float height = ImGui::GetTextLineHeight();
      ImDrawList* list = ImGui::GetWindowDrawList();
      const auto points = scene::make_color_map(name, 0, 1);
      for (int i = 0; i < 24; ++i)
        list->AddRectFilled({at.x + 2 * static_cast<float>(i), at.y}, {at.x + 2 * static_cast<float>(i + 1), at.y + height},
                            to_imgui_color(evaluate_color(points, i / 23.0)));
      list->AddText({at.x + 56, at.y}, ImGui::GetColorU32(ImGuiCol_Text), word.c_str());
      if (const std::string_view warning = scene::color_map_warning(name); !warning.empty()) show_tooltip(std::string(warning));
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

std::optional<scene::ValueMapping> choose_mapping(const scene::ValueMapping& now, double linear_below) {
  std::optional<scene::ValueMapping> chosen;
  int kind = static_cast<int>(now.kind);
  ImGui::SetNextItemWidth(78);
  if (ImGui::Combo("mapping", &kind, "linear\0log\0symlog\0") && kind != static_cast<int>(now.kind))
    chosen = {static_cast<scene::ValueMapping::Kind>(kind), 0};
  show_short_tooltip("scale between the points: linear, logarithmic, or symmetric logarithmic with a linear part around 0");
  if (now.kind != scene::ValueMapping::Kind::symlog) return chosen;
  ImGui::SameLine();
  ImGui::SetNextItemWidth(78);
  double size = now.linear_below > 0 ? now.linear_below : linear_below;
  if (input_number("linear below", size, "absolute value up to which the scale is linear; Enter applies") && size > 0)
    chosen = {now.kind, size};
  return chosen;
}

std::array<double, 2> first_threshold(const field::AnyField& shown) {
  if (!shown.scalar || !shown.scalar->is_grid()) return {0.0, 1.0};
  return {shown.scalar->min_value(), shown.scalar->max_value()};
}

namespace {

/// Returns the display range of the field that colors an item, else of the item's own field, whose magnitude is the speed; else 0 to 1.
std::array<double, 2> shown_range(const scene::Scene& scene, const json::Node& item, const scene::ColorBy& by) {
  scene::Entity field = by.field;
  if (const json::Node* name = item.find("field"); !field && name != nullptr) field = scene::find_field(scene, name->string);
  if (!field) return {0.0, 1.0};
  const scene::FieldSource& source = scene.entities.get<scene::FieldSource>(field);
  const field::AnyField& values = source.rendered.get() != nullptr ? source.rendered : source.loaded;
  if (values.get() == nullptr || !values.get()->is_grid()) return {0.0, 1.0};
  const DisplayRange range = field::display_range(values);
  return scene::is_color_range(range.lo, range.hi) ? std::array{range.lo, range.hi} : std::array{0.0, 1.0};
}

}  // namespace

void edit_threshold(Edits& edits, const std::string& pointer, const Threshold& threshold, const std::array<double, 2>& data) {
  ImGui::PushID("threshold");
  bool on = !threshold.empty();
  if (ImGui::Checkbox("threshold", &on)) {
    if (on)
      edits.set(pointer, scene::to_json(data), "threshold");
    else
      edits.remove(pointer, "threshold");
  }
  show_short_tooltip("show only where the values lie between two bounds");
  for (std::size_t i = 0; i < threshold.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    Threshold now = threshold;
    ImGui::SetNextItemWidth(0.32f * ImGui::GetContentRegionAvail().x);
    bool typed = input_number("##lowest", now[i][0], "lowest value that is shown; Enter applies");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(0.45f * ImGui::GetContentRegionAvail().x);
    typed = input_number("shown", now[i][1], "highest value that is shown; Enter applies") || typed;
    if (typed) edits.set(pointer, scene::to_json(now), "threshold");
    ImGui::PopID();
  }
  ImGui::PopID();
}

void edit_color_scale(Edits& edits, const scene::Scene& scene, const json::Node& item, const scene::ColorBy& by, bool has_threshold) {
  const auto& table = by.colors;
  const scene::NamedColors& named = by.named;
  // the item has the keys itself, or inside its "color_by"
  const std::string pointer = item_pointer(item) + (by.where.label == "color_by" ? "/color_by" : "");
  const bool file = by.where.find("transfer") != nullptr;
  const bool labels = by.field && scene::shows_labels(scene, by.field, table, named);
  ImGui::PushID("scale");
  if (const auto map = choose_color_map(
          table.empty() && named.map.empty() && !labels ? std::string(scene::kDefaultLineColorMap) : named.map, labels ? "colours of labels"
                                                                                                                : file ? "from a file"
                                                                                                                       : "custom")) {
    TextEdits change{{pointer + "/color", scene::to_json(*map)}};
    if (file) change.insert(change.begin(), {{pointer + "/transfer", std::nullopt}, {pointer + "/range", std::nullopt}});
    edits.set(change, "colours");
  }
  if (table.empty() && !file && !labels) {
    bool own = named.range.has_value();
    if (named.range) {
      std::array<double, 2> range = *named.range;
      ImGui::SetNextItemWidth(0.32f * ImGui::GetContentRegionAvail().x);
      bool typed = input_number("##from", range[0], "value of the first colour; Enter applies");
      ImGui::SameLine();
      ImGui::SetNextItemWidth(0.45f * ImGui::GetContentRegionAvail().x);
      typed = input_number("range", range[1], "value of the last colour; Enter applies") || typed;
      if (typed) edits.set(pointer + "/range", scene::to_json(range), "range");
      ImGui::SameLine();
      if (ImGui::Checkbox("##own", &own)) edits.remove(pointer + "/range", "range");
      show_short_tooltip("off: the range of the field's values");
    } else if (ImGui::Checkbox("own range", &own)) {
      edits.set(pointer + "/range", scene::to_json(shown_range(scene, item, by)), "range");
    }
  }
  if (const auto mapping = labels ? std::nullopt : choose_mapping(named.mapping, 0)) {
    const auto stated = [](bool is, const std::string& text) { return is ? std::optional(text) : std::nullopt; };
    edits.set({{pointer + "/mapping",
                stated(mapping->kind != scene::ValueMapping::Kind::linear, scene::to_json(scene::to_string(mapping->kind)))},
               {pointer + "/linear_below", stated(mapping->linear_below > 0, scene::to_json(mapping->linear_below))}},
              "mapping");
  }
  if (has_threshold) {
    const field::AnyField shown = by.field ? scene.entities.get<scene::FieldSource>(by.field).rendered : field::AnyField{};
    edit_threshold(edits, pointer + "/threshold", named.threshold, first_threshold(shown));
  }
  ImGui::PopID();
}

void edit_colors(Edits& edits, const scene::Scene& scene, const json::Node& item, const Color& color,
                 const std::optional<scene::ColorBy>& by, const std::vector<std::string>& quantities, bool has_threshold) {
  using What = scene::ColorBy::Source;
  const std::string pointer = item_pointer(item), alone = "one colour";
  const std::string now = !by                         ? alone
                          : by->source == What::field ? entity_name(scene, by->field)
                          : by->source == What::speed ? "speed"
                                                      : "arc_length";
  if (ImGui::BeginCombo("colour by", now.c_str())) {
    std::vector<std::string> choices{alone};
    choices.insert(choices.end(), quantities.begin(), quantities.end());
    for (const std::string& name : field_names(scene)) choices.push_back(name);
    for (std::size_t i = 0; i < choices.size(); ++i) {
      const std::string& choice = choices[i];
      if (!ImGui::Selectable(choice.c_str(), choice == now) || choice == now) continue;
      TextEdits change;
      if (choice == alone) {
        change.push_back({pointer + "/color_by", std::nullopt});
        change.push_back({pointer + "/color", scene::to_json(color)});
      } else {
        scene::ColorBy other;
        other.source = i > quantities.size() ? What::field : choice == "speed" ? What::speed : What::arc_length;
        if (other.source == What::field) other.field = scene::find_field(scene, choice);
        const bool is_label_map = other.field && scene::find_label_map(scene, other.field) != nullptr;
        if (!is_label_map) other.named.map = by && !by->named.map.empty() ? by->named.map : std::string(scene::kDefaultLineColorMap);
        change.push_back({pointer + "/color_by", scene::to_json(scene, other)});
      }
      edits.set(change, "colours");
    }
    ImGui::EndCombo();
  }
  if (by)
    edit_color_scale(edits, scene, item, *by, has_threshold);
  else
    edit_color(edits, "colour", color, pointer + "/color");
}

void edit_auto_length(Edits& edits, const char* key, const json::Node& item, double value, double max_value, const char* hint) {
  const std::string pointer = item_pointer(item) + "/" + key;
  auto now = static_cast<float>(value);
  if (ImGui::SliderFloat(key, &now, 0, static_cast<float>(max_value), value > 0 ? "%.4g" : "automatic",
                         ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat | ImGuiSliderFlags_Logarithmic)) {
    const double to = round_within(now, 0, max_value);
    if (to > 0)
      edits.drag(pointer, scene::to_json(to), key);
    else if (item.find(key) != nullptr)
      edits.remove(pointer, key);
  }
  show_short_tooltip(hint);
}

void draw_histogram_bars(const PlotTransform& frame, const SortedSamples& values, ImU32 color) {
  if (!values) return;
  const int bars = std::clamp(static_cast<int>((frame.right - frame.left) / 2), 1, 400);
  const std::vector<float> heights = histogram_bars(*values, frame.lo, frame.hi, bars, frame.linear_below);
  ImDrawList* list = ImGui::GetWindowDrawList();
  const double width = (frame.right - frame.left) / bars;
  for (int i = 0; i < bars; ++i) {
    const double top = frame.bottom - 0.95 * heights[static_cast<std::size_t>(i)] * (frame.bottom - frame.top);
    if (top >= frame.bottom) continue;
    list->AddRectFilled({static_cast<float>(frame.left + i * width), static_cast<float>(top)},
                        {static_cast<float>(frame.left + (i + 1) * width), static_cast<float>(frame.bottom)}, color);
  }
}

bool histogram_slider(PanelContext& context, const char* id, const SortedSamples& values, double lo, double hi, const Color& color,
                      double& value) {
  const auto range = make_plot_range(lo, hi);
  const ImVec2 at = ImGui::GetCursorScreenPos(), size{ImGui::GetContentRegionAvail().x, kBarsHeight};
  ImGui::InvisibleButton(id, size);
  const PlotTransform frame{at.x, at.y, at.x + size.x, at.y + size.y, range[0], range[1]};
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(at, {at.x + size.x, at.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg), 3);
  draw_histogram_bars(frame, values, ImGui::GetColorU32(ImGuiCol_Text, 0.35f));

  // relative to the position of the press; with Ctrl at a tenth of the speed
  AppearanceState& look = context.state.appearance;
  bool moved = false;
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemActivated()) {
    look.handle_x = io.MousePos.x;
    moved = true;
  } else if (ImGui::IsItemActive() && io.MouseDelta.x != 0) {
    look.handle_x += io.MouseDelta.x * (io.KeyCtrl ? kFine : 1);
    moved = true;
  }
  const double before = value;
  if (moved && std::isfinite(lo) && std::isfinite(hi))
    value = std::clamp(round_within(frame.value_at(look.handle_x), range[0], range[1], io.KeyCtrl ? 20000 : 2000), lo, hi);
  const auto x = static_cast<float>(std::clamp(frame.to_x(value), frame.left, frame.right));
  list->AddLine({x, at.y}, {x, at.y + size.y}, ImGui::GetColorU32(ImVec4(0, 0, 0, 0.8f)), 5);
  list->AddLine({x, at.y}, {x, at.y + size.y}, to_imgui_color(color), 3);
  if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) ImGui::SetTooltip("%.6g .. %.6g\nCtrl and drag: fine", lo, hi);
  return value != before;
}

}  // namespace catena::app
