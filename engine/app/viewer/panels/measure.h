// SPDX-License-Identifier: MIT
/// Parts of the panel of measuring. Frame thread, between Gui::begin and end.
#pragma once
#include "engine/app/viewer/panels/panel.h"

namespace catena::app {

/// Returns whether a label map is loaded.
bool has_label_map(const scene::Scene& scene);
/// Draws the table of the labels of a label map; only with has_label_map().
void draw_label_statistics(PanelContext& context);

}  // namespace catena::app
