// SPDX-License-Identifier: MIT
// Panel of field values: under the pointer, at the probe, at the last proxy.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "engine/app/viewer/panels/panel.h"
#include "engine/scene/units.h"

namespace catena::app {

namespace {

constexpr const char* kNone = "-";

void cell(const std::string& text, const std::string& more = {}) {
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(text.empty() ? kNone : text.c_str());
  if (!more.empty() && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", more.c_str());
}

void draw_coordinate(const char* name, int axis, const std::array<const PointSamples*, 3>& places, const std::string& unit) {
  ImGui::TableNextRow();
  cell(name + (unit.empty() ? "" : " " + unit));
  for (const PointSamples* place : places) cell(place->world ? fmt::format("{:.5g}", (*place->world)[axis]) : "");
}

const FieldSample* find(const PointSamples& place, const std::string& name) {
  const auto found = std::ranges::find(place.samples, name, &FieldSample::name);
  return found == place.samples.end() ? nullptr : &*found;
}

void draw_values(PanelContext& context) {
  const ViewState& state = context.state;
  const std::array<const PointSamples*, 3> places{&state.pointer_samples, &state.probe_samples, &state.proxy_samples};
  constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV;
  if (!ImGui::BeginTable("##values", 4, kFlags)) return;
  const float width = 0.2f * side_panel_width();
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch);
  for (const char* title : {"pointer", "probe", "proxy"}) ImGui::TableSetupColumn(title, ImGuiTableColumnFlags_WidthFixed, width);
  ImGui::TableHeadersRow();
  for (int axis = 0; axis < 3; ++axis) draw_coordinate(axis == 0 ? "x" : axis == 1 ? "y" : "z", axis, places, state.unit_length);

  // rows of the longest list: the loaded fields are the same at every point
  const PointSamples& maximum = **std::ranges::max_element(places, {}, [](const PointSamples* p) { return p->samples.size(); });
  for (const FieldSample& row : maximum.samples) {
    ImGui::TableNextRow();
    cell(row.name + scene::unit_suffix(row.unit));
    for (const PointSamples* place : places) {
      const FieldSample* value = find(*place, row.name);
      if (value == nullptr)
        cell("");
      else
        cell(format_sample(*value), value->vector ? format_sample(*value, true) + scene::unit_suffix(value->unit) : "");
    }
  }
  ImGui::TableNextRow();
  cell("object");
  for (const PointSamples* place : places) cell(place->object, place->object);
  ImGui::EndTable();
}

}  // namespace

Panel values_panel() { return {"Values", false, draw_values}; }

}  // namespace catena::app
