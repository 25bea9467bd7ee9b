/// Makes ready what a scene describes: drives what follows widgets, loads the fields and meshes that something visible names, traces its
/// lines. Who draws or feels the scene afterwards only reads it. Frame thread.
#pragma once
#include "engine/base/bounds.h"
#include "engine/base/haptic_state.h"
#include "engine/scene/scene.h"

namespace catena::scene {

/// Whether prepare traces the streamlines, or leaves them to a caller that visits them block by block (lines.h).
enum class StreamlineTracing { immediate, deferred };

/// Nothing is made twice: a scene in which nothing has changed costs nothing. Errors carry the scene file's name and line.
Outcome prepare(Scene& scene, StreamlineTracing streamlines = StreamlineTracing::immediate);

/// The world box of all that is loaded, drawn or felt, and of the lines. Empty before prepare.
Bounds scene_bounds(const Scene& scene);

/// Systems: free functions over the world, run by the frame between the tick's news and the picture. Frame thread only.

/// The cursor follows the newest haptic state: probe, proxies, which of them hold, force (world axes, N). A state whose probe
/// is not finite leaves the cursor where it was.
void update_cursor(Scene& scene, const HapticState& state);

/// Takes over the reports of the tick: pose, value, mode, handle and planes of each widget. Reports about another list of widgets, of
/// another revision than the pose that was set last, or not finite, are ignored. Whether a pose or value changed.
bool update_widgets(Scene& scene, const HapticState& state);

/// What changed since the last propagate_widgets.
struct WidgetChanges {
  bool slices = false;                               ///< or the planes of glyphs
  bool clip = false, seeds = false, levels = false;  ///< what else has to be made anew
  bool links = false;  ///< a link of the chain names a widget that moved: the program must be made and published again
  /// Whether anything has.
  bool any() const { return slices || clip || seeds || levels || links; }
};

/// Slices, planes of glyphs, clip planes, seeds and isosurfaces that name a widget follow its pose; a level stays within the values of the
/// field that it is drawn of. Completes the widgets (resolve_widget); those that have not moved cost nothing. prepare (prepare.h) calls it.
Result<WidgetChanges> propagate_widgets(Scene& scene);

}  // namespace catena::scene
