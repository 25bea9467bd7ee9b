/// Widgets on the scene's side: their poses as set from a panel or taken over from the tick, and what follows them: slices, clip planes,
/// seeds, levels, and links of the chain. World units. Frame thread.
#pragma once
#include "engine/scene/scene.h"

namespace catena::scene {

/// "cutting_plane", "seed", ...: the word of the scene file.
const char* to_string(widget::Kind kind);

/// Unit length; bit for bit as it was where it is unit to rounding.
Quat normalize_orientation(const Quat& q);

/// The planes, places and numbers that follow from a pose.
Vec3 plane_normal(const widget::Pose& pose);                                 ///< a cutting plane's
ClipPlane make_clip_plane(const widget::Pose& pose, const ClipPlane& like);  ///< of the widget, face and side of `like`
std::vector<Vec3> make_widget_seeds(widget::Kind kind, const widget::Pose& pose, int count);

/// Sets the pose from outside (a panel, undo): the hand's pose gives way to it, reports of an older revision are ignored from now on. The
/// orientation is made unit. Only the members that the kind reads count. An error, and nothing changes, where a number is not finite, or
/// a box has no inside.
Outcome set_widget_pose(Scene& scene, Entity widget, const widget::Pose& pose);

/// Whether a link names the widget ("seed": {"widget": NAME}, "level": {"widget": NAME}): it is felt where the widget is.
bool has_haptic_link(const Scene& scene, Entity widget);

}  // namespace catena::scene
