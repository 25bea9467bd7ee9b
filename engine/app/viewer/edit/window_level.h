// SPDX-License-Identifier: MIT
/// Window and level of the 3D view: the range of values that the colors of a volume, or of a slice, span. Frame thread.
#pragma once
#include "engine/app/viewer/edit/scene_items.h"

namespace catena::app {

/// Returns the edits that widen the range of the first visible volume, else slice, by `wider` times the field's display range, and raise
/// its middle by `higher` times it. Empty: nothing visible has such a range, or the range cannot be changed so.
TextEdits make_window_level_edits(const scene::Scene& scene, double wider, double higher);

}  // namespace catena::app
