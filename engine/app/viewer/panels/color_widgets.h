// SPDX-License-Identifier: MIT
/// Widgets shared by the panels for the appearance of the scene, in addition to property_widgets.h: color scales and histograms. Frame
/// thread, between Gui::begin and end.
#pragma once
#include <imgui.h>

#include <optional>
#include <string>
#include <vector>

#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/edit/transfer_editing.h"
#include "engine/app/viewer/panels/panel.h"
#include "engine/app/viewer/panels/property_widgets.h"
#include "engine/scene/to_json.h"

namespace catena::app {

/// Draws the color scale of an item colored by values: color map, reversed or not, range, mapping, and a threshold if the item has one.
void edit_color_scale(Edits& edits, const scene::Scene& scene, const json::Node& item, const scene::ColorBy& by, bool has_threshold = true);
/// Draws the colors of an item that has either one color ("color") or is colored by values ("color_by"): those of a field, or one of its
/// own `quantities`.
void edit_colors(Edits& edits, const scene::Scene& scene, const json::Node& item, const Color& color,
                 const std::optional<scene::ColorBy>& by, const std::vector<std::string>& quantities, bool has_threshold = true);
/// Draws a combo box of the color maps. Returns the chosen name, with "_r" if reversed; nothing if unchanged.
std::optional<std::string> choose_color_map(const std::string& now, const char* otherwise);
/// Draws the ranges of shown values; `pointer`: the key "threshold"; `data`: the range that a first threshold states.
/// first_threshold() returns the range of all values of a grid, else 0 to 1.
std::array<double, 2> first_threshold(const field::AnyField& shown);
void edit_threshold(Edits& edits, const std::string& pointer, const Threshold& threshold, const std::array<double, 2>& data);
/// Draws a combo box of the scales between points, and the linear part of symlog (`linear_below`: its resolved value). Returns the choice;
/// nothing if unchanged.
std::optional<scene::ValueMapping> choose_mapping(const scene::ValueMapping& now, double linear_below);

/// Draws a slider for the length `key` of an item, from 0, which removes the key from the text, to `max_value`.
void edit_auto_length(Edits& edits, const char* key, const json::Node& item, double value, double max_value, const char* hint);

/// Draws the histogram as bars.
void draw_histogram_bars(const PlotTransform& frame, const SortedSamples& values, ImU32 color);
/// Draws a histogram with a line at the value, moved by the pointer, and finely (a tenth) with Ctrl. Returns true while it is being moved.
bool histogram_slider(PanelContext& context, const char* id, const SortedSamples& values, double lo, double hi, const Color& color,
                      double& value);

/// Converts a color for ImGui.
inline ImU32 to_imgui_color(const Color& c, float alpha = 1) { return ImGui::GetColorU32(ImVec4(c.r, c.g, c.b, alpha)); }

}  // namespace catena::app
