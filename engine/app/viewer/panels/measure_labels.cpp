// SPDX-License-Identifier: MIT
// Statistics of the labels of a label map, in the panel of measuring.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "engine/app/viewer/edit/histogram_cache.h"
#include "engine/app/viewer/edit/label_opacity.h"
#include "engine/app/viewer/panels/measure.h"
#include "engine/app/viewer/panels/property_widgets.h"
#include "engine/scene/labels.h"
#include "engine/scene/units.h"

namespace catena::app {

namespace {

constexpr const char* kNoValues = "none";
constexpr float kTableRows = 12;

std::vector<std::string> label_maps(const scene::Scene& scene) {
  std::vector<std::string> names;
  scene.entities.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource& source) {
    if (source.labels && source.loaded.scalar && source.loaded.scalar->grid() != nullptr) names.push_back(entity_name(scene, e));
  });
  return names;
}

/// "none", and the scalar fields that are loaded and no label map.
std::vector<std::string> value_fields(const scene::Scene& scene) {
  std::vector<std::string> names{kNoValues};
  scene.entities.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource& source) {
    if (source.loaded.scalar && !source.labels && !source.label) names.push_back(entity_name(scene, e));
  });
  return names;
}

/// Draws a number within the width of a column: no exponent below 10 million.
void number_cell(double value) {
  ImGui::TableNextColumn();
  if (!std::isfinite(value)) return;
  const double magnitude = std::fabs(value);
  const std::string text = magnitude >= 1e3 && magnitude < 1e7 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
  ImGui::TextUnformatted(text.c_str());
}

void draw_row(const LabelStatistics& row, bool with_values, std::optional<double>& selected) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  const std::string number = fmt::format("{}", row.label);
  ImGui::PushID(number.c_str());
  if (ImGui::Selectable(row.name.empty() ? number.c_str() : row.name.c_str(), selected == row.label, ImGuiSelectableFlags_SpanAllColumns))
    selected = selected == row.label ? std::nullopt : std::optional(row.label);
  ImGui::PopID();
  show_tooltip(row.name.empty() ? "label " + number : row.name + ", label " + number);
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(std::to_string(row.voxels).c_str());
  number_cell(row.volume);
  if (!with_values) return;
  number_cell(row.mean);
  number_cell(row.deviation);
}

/// Draws the header; a click on a title sorts the rows by this column, another one reverses them.
void draw_header(AppearanceState::Measure& shown, const std::vector<std::string>& titles) {
  ImGui::TableSetupScrollFreeze(0, 1);
  constexpr float kWidths[] = {0, 0.14f, 0.145f, 0.125f, 0.105f};  // of the panel
  for (std::size_t c = 0; c < titles.size(); ++c)
    ImGui::TableSetupColumn(titles[c].c_str(), c == 0 ? ImGuiTableColumnFlags_WidthStretch : ImGuiTableColumnFlags_WidthFixed,
                            kWidths[c] * side_panel_width());
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (std::size_t c = 0; c < titles.size(); ++c) {
    ImGui::TableNextColumn();
    const auto column = static_cast<LabelColumn>(c);
    const bool is_sorted = shown.sorted_by == column;
    if (ImGui::Selectable(titles[c].c_str(), is_sorted)) {
      shown.is_descending = is_sorted ? !shown.is_descending : column != LabelColumn::name;
      shown.sorted_by = column;
      sort_labels(shown.rows, column, shown.is_descending);
    }
    show_short_tooltip("sorts the rows; once more: the other way round");
  }
}

void draw_table(AppearanceState::Measure& shown, bool with_values, const std::string& volume_unit) {
  constexpr ImGuiTableFlags kFlags =
      ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV | ImGuiTableFlags_Resizable;
  std::vector<std::string> titles{"name", "voxels", volume_unit.empty() ? "volume" : volume_unit};
  if (with_values) titles.insert(titles.end(), {"mean", "dev."});
  const float row = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
  const float height = (std::min(kTableRows, static_cast<float>(shown.rows.size())) + 1) * row;
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, {3, ImGui::GetStyle().CellPadding.y});
  const bool open = ImGui::BeginTable(with_values ? "##labels-values" : "##labels", static_cast<int>(titles.size()), kFlags, {0, height});
  ImGui::PopStyleVar();
  if (!open) return;
  draw_header(shown, titles);
  ImGuiListClipper visible;
  visible.Begin(static_cast<int>(shown.rows.size()));
  while (visible.Step())
    for (int n = visible.DisplayStart; n < visible.DisplayEnd; ++n)
      draw_row(shown.rows[static_cast<std::size_t>(n)], with_values, shown.selected);
  ImGui::EndTable();
}

/// Draws the opacity of the selected label.
void draw_opacity(PanelContext& context, const AppearanceState::Measure& shown) {
  const auto row = std::ranges::find_if(shown.rows, [&](const LabelStatistics& r) { return r.label == shown.selected; });
  if (row == shown.rows.end()) return ImGui::TextDisabled("a click on a row selects a label");
  const scene::Scene& scene = context.scene.scene();
  auto opacity = static_cast<float>(label_opacity(scene, shown.map, row->label));
  if (ImGui::SliderFloat("opacity", &opacity, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp)) {
    TextEdits edits = make_label_opacity_edits(scene, shown.map, row->label, round_within(opacity, 0, 1, 100));
    if (edits.empty()) return context.state.show_message(fmt::format("the surface has more than {} labels", kMaxListedLabels), true);
    context.edits.drag(std::move(edits), "opacity of a label");
  }
  show_tooltip("of the selected label; it gets a surface of its own");
}

}  // namespace

bool has_label_map(const scene::Scene& scene) { return !label_maps(scene).empty(); }

void draw_label_statistics(PanelContext& context) {
  const scene::Scene& scene = context.scene.scene();
  AppearanceState::Measure& chosen = context.state.appearance.measure;
  const std::vector<std::string> maps = label_maps(scene), fields = value_fields(scene);
  ImGui::Separator();
  if (std::ranges::find(maps, chosen.map) == maps.end()) chosen.map = maps.front();
  if (std::ranges::find(fields, chosen.values) == fields.end()) chosen.values = fields.size() > 1 ? fields[1] : kNoValues;
  if (maps.size() > 1) choose_from_list("labels", maps, chosen.map);
  if (fields.size() > 1) choose_from_list("mean of", fields, chosen.values);
  const bool with_values = chosen.values != kNoValues;
  const auto& map = scene.entities.get<scene::FieldSource>(scene::find_field(scene, chosen.map));
  LabelStatisticsCache::Request request{map.loaded.scalar, {}};
  if (with_values) request.values = scene.entities.get<scene::FieldSource>(scene::find_field(scene, chosen.values)).loaded.scalar;
  const auto table = chosen.labels.find_or_request(request, map.labels_table);
  if (!table) {
    ImGui::TextDisabled("computing the statistics of %s ...", chosen.map.c_str());
    return;
  }
  if (!*table) {
    ImGui::TextWrapped("%s: %s", chosen.map.c_str(), table->error().message.c_str());
    return;
  }
  if (chosen.table != table) {
    chosen.table = table;
    chosen.rows = **table;
    sort_labels(chosen.rows, chosen.sorted_by, chosen.is_descending);
  }
  const std::string unit = context.state.unit_length.empty() ? "" : context.state.unit_length + "3";
  draw_table(chosen, with_values, unit);
  draw_opacity(context, chosen);
  if (ImGui::Button("Copy table as CSV")) {
    ImGui::SetClipboardText(labels_to_csv(chosen.rows, with_values).c_str());
    context.state.show_message(fmt::format("copied {} labels of {}", chosen.rows.size(), chosen.map));
  }
  show_tooltip("the rows as they are sorted; catena measure also writes surfaces and positions to a file");
}

}  // namespace catena::app
