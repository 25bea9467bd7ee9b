// SPDX-License-Identifier: MIT
/// Opacity of one label of a label map, whose surfaces in the image may hold many labels each. Frame thread.
#pragma once
#include "engine/app/viewer/edit/scene_items.h"

namespace catena::app {

/// Maximum number of labels of a surface from which one label can be taken out; the scene's text lists the others.
inline constexpr std::size_t kMaxListedLabels = 1000;

/// Returns the opacity at which a label of the map is drawn; 0: no visible surface holds it.
double label_opacity(const scene::Scene& scene, const std::string& map, double label);
/// Returns the edits that draw a label with this opacity. A label that shares its surface with others gets a surface of its own. Empty: its
/// surface holds more than kMaxListedLabels labels.
TextEdits make_label_opacity_edits(const scene::Scene& scene, const std::string& map, double label, double opacity);

}  // namespace catena::app
