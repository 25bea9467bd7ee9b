// SPDX-License-Identifier: MIT
/// Widgets in the scene: their poses, set by the user interface or taken from the tick report, and the objects bound to them: slices, clip
/// planes, seeds, levels, and links of the chain. World units. Frame thread.
#pragma once
#include "engine/scene/scene.h"

namespace catena::scene {

/// Returns the name of a kind in the scene file: "cutting_plane", "seed", ...
const char* to_string(widget::Kind kind);

/// Returns the quaternion with unit length; returned bit for bit if its length is 1 to rounding.
Quat normalize_orientation(const Quat& q);

/// Returns the normal of a cutting plane with that pose.
Vec3 plane_normal(const widget::Pose& pose);
/// Returns the clip plane for the pose, with the widget, box face and side of `like`.
ClipPlane make_clip_plane(const widget::Pose& pose, const ClipPlane& like);
/// Returns `count` points along a rake; the handle of any other kind.
std::vector<Vec3> make_widget_seeds(widget::Kind kind, const widget::Pose& pose, int count);

/// Sets the pose from outside (a panel, undo). It replaces the user's pose: reports of an older revision are ignored afterwards. The
/// orientation is normalized. Only the members that the kind uses are read. Error (nothing changes): a number is not finite, or a box is
/// empty.
Outcome set_widget_pose(Scene& scene, Entity widget, const widget::Pose& pose);

/// Returns whether a link of the chain names the widget ("seed": {"widget": NAME}, "level": {"widget": NAME}), so that its haptic feature
/// moves with the widget.
bool has_haptic_link(const Scene& scene, Entity widget);

}  // namespace catena::scene
