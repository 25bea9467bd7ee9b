// SPDX-License-Identifier: MIT
/// Preparation of a scene for rendering and haptics: applies widget poses to the objects bound to them, loads the fields and meshes that
/// visible objects name, and traces their streamlines. Rendering and haptics then only read the scene. Frame thread.
#pragma once
#include "engine/base/bounds.h"
#include "engine/base/export.h"
#include "engine/base/haptic_state.h"
#include "engine/scene/scene.h"

namespace catena::scene {

/// Time at which streamlines are traced. immediate: by prepare; deferred: by a caller that visits them block by block (visit_lines,
/// streamlines.h).
enum class StreamlineTracing { immediate, deferred };

/// Prepares the scene. Results are cached: an unchanged scene costs nothing. Errors have the scene file's name and line.
CATENA_EXPORT Outcome prepare(Scene& scene, StreamlineTracing streamlines = StreamlineTracing::immediate);

/// Returns the bounds, in world units, of everything loaded and of the visible streamlines. Empty before prepare.
CATENA_EXPORT Bounds scene_bounds(const Scene& scene);

// Systems: free functions over the entities, run once a frame, after the tick report is received and before the image is rendered.
// Frame thread only.

/// Writes the newest haptic state to the cursor: probe, proxies, which links are active, force (world axes, N). A state with a non-finite
/// probe is ignored.
CATENA_EXPORT void update_cursor(Scene& scene, const HapticState& state);

/// Writes the tick report of each widget to its component: pose, value, mode, handle and planes. Ignores reports for another number of
/// widgets, for a revision other than that of the pose set last, or with non-finite values. Returns whether a pose or value changed.
CATENA_EXPORT bool update_widgets(Scene& scene, const HapticState& state);

/// Changes since the previous call of propagate_widgets.
struct WidgetChanges {
  bool slices = false;                               ///< Slices or planes of glyphs
  bool clip = false, seeds = false, levels = false;  ///< Clip planes, seeds of streamlines, levels of isosurfaces
  /// A widget that a link of the chain names has moved: the haptic program must be built and published again.
  bool links = false;
  /// Returns whether anything changed.
  bool any() const { return slices || clip || seeds || levels || links; }
};

/// Applies widget poses to the slices, planes of glyphs, clip planes, seeds and isosurfaces bound to them; a level is clamped to the values
/// of the field that is rendered. Completes the widgets (resolve_widget). Widgets that have not moved cost nothing. Called by prepare.
CATENA_EXPORT Result<WidgetChanges> propagate_widgets(Scene& scene);

}  // namespace catena::scene
