/// This file has the parts that the panels of the scene's look share beside the plain items of edit_items.h: the colours of values, and
/// histograms. Frame thread, between Gui::begin and end.
#pragma once
#include <imgui.h>

#include <optional>
#include <string>
#include <vector>

#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/edit/transfer_edit.h"
#include "engine/app/viewer/panels/edit_items.h"
#include "engine/app/viewer/panels/panel.h"
#include "engine/scene/write_values.h"

namespace catena::app {

/// The colours of an item that colours by values: a map's name, reversed or not, its range.
void edit_color_scale(Edits& edits, const json::Node& item, const scene::ColorBy& by);
/// A combo of the maps' names. The name chosen, "_r" with it.
std::optional<std::string> choose_map(const std::string& now, const char* otherwise);

/// Grey bars of how often values occur.
void draw_bars(const PlotFrame& frame, const SortedValues& values, ImU32 color);
/// A histogram with a line at the value, which the pointer moves; with Ctrl finely. True while it moves.
bool histogram_slider(PanelContext& context, const char* id, const SortedValues& values, double lo, double hi, const Color& color,
                      double& value);

inline ImU32 packed(const Color& c, float alpha = 1) { return ImGui::GetColorU32(ImVec4(c.r, c.g, c.b, alpha)); }

}  // namespace catena::app
