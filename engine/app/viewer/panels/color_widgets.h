/// This file has the parts that the panels of the scene's look share beside the plain items of edit_items.h: the colours of values, and
/// histograms. Frame thread, between Gui::begin and end.
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

/// The colours of an item that colours by values: a map's name, reversed or not, its range, its scale.
void edit_color_scale(Edits& edits, const json::Node& item, const scene::ColorBy& by);
/// Those of an item that has one colour ("color") or the colours of values ("color_by"): a field's, or one of the `quantities` that it
/// knows itself.
void edit_colors(Edits& edits, const scene::Scene& scene, const json::Node& item, const Color& color,
                 const std::optional<scene::ColorBy>& by, const std::vector<std::string>& quantities);
/// A combo of the maps' names. The name chosen, "_r" with it.
std::optional<std::string> choose_color_map(const std::string& now, const char* otherwise);
/// A combo of the scales between points, and what is linear of symlog (`linear_below`: as it is drawn). What was chosen.
std::optional<scene::ValueMapping> choose_mapping(const scene::ValueMapping& now, double linear_below);

/// The length `key` of an item, from 0, which takes it out of the text, to `most`.
void edit_auto_length(Edits& edits, const char* key, const json::Node& item, double value, double most, const char* hint);

/// Grey bars of how often values occur.
void draw_histogram_bars(const PlotTransform& frame, const SortedSamples& values, ImU32 color);
/// A histogram with a line at the value, which the pointer moves; with Ctrl finely. True while it moves.
bool histogram_slider(PanelContext& context, const char* id, const SortedSamples& values, double lo, double hi, const Color& color,
                      double& value);

inline ImU32 to_imgui_color(const Color& c, float alpha = 1) { return ImGui::GetColorU32(ImVec4(c.r, c.g, c.b, alpha)); }

}  // namespace catena::app
