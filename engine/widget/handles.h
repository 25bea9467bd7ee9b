// SPDX-License-Identifier: MIT
/// Widgets with handles, and the translation of any widget (Grip in widget.h): planes across the axes of a frame, through the point at
/// which the widget was grabbed. World units. Haptic thread: no allocation, lock, throw.
#pragma once
#include "engine/widget/widget.h"

namespace catena::widget {

/// Adds the planes that hold the probe at its position; sets state.active_planes.
void add_planes(const Spec& spec, State& state, const Vec3& probe, ChainRequest& plan) noexcept;
/// Returns the displacement of the widget along each axis of the grip's frame: exactly 0 along an axis that a plane holds.
Vec3 displacement(const Spec& spec, const State& state, const Vec3& proxy) noexcept;
/// Returns `from` moved by a displacement in the axes of `frame`; a zero component changes no bit of the result.
Vec3 translated(const Vec3& from, const Quat& frame, const Vec3& displacement) noexcept;

/// Parts of a widget that a probe is near. World units.
struct Proximity {
  std::int8_t nearest_handle = -1;  ///< Nearest handle, or the arrow of a cutting plane, within grab_distance; -1: none
  bool near_sphere = false;         ///< Cutting plane: near its sphere
  bool near_plane = false;          ///< Cutting plane: near its plane
  double distance = 0;              ///< Distance from the nearest of these parts, or from the sphere if that is near
};

/// Widgets with handles: seed, rake, isolevel, box, ruler. Notation: x probe, h position of a handle.
///   hover   |x - h| <= grab_distance of the nearest handle (the current handle is kept as long as this holds): [point at h]
///   drag    planes of a Grip:
///     seed, ends and middle of rake and ruler, center of the box: across the pose's axes (box: the world's axes); each plane releases the
///     probe at `step`
///     face of the box: the two planes along its normal always hold, the face moves with the probe; opposite faces keep a minimum distance,
///     `step` or their distance at the press if that is less
///     isolevel: the two planes along the gradient always hold, the handle moves with the probe; without a gradient, as a seed
///     end of a ruler with `along_links`: those links of the scene instead of planes; the end is their last proxy
///
/// Returns the number of handles of a kind; 0 for a cutting plane.
int handle_count(Kind kind) noexcept;
/// Returns the position of a handle; WidgetReport::handle states the numbering.
Vec3 handle_position(Kind kind, const Pose& pose, int handle) noexcept;

/// Returns the nearest handle of the probe.
Proximity handle_proximity(const Spec& spec, const State& state, const Vec3& probe) noexcept;
/// Returns the grip for dragging state.handle, or a cutting plane's arrow, from the probe.
Grip make_grip(const Spec& spec, const State& state, const Vec3& probe) noexcept;
/// Returns the links for the current mode.
ChainRequest plan_handle_chain(const Spec& spec, State& state, const Vec3& probe) noexcept;
/// Updates the pose in mode drag from the last proxy of the chain.
void update_handle_pose(const Spec& spec, State& state, const Vec3& proxy) noexcept;
/// Sets an isolevel's value to that of the field at the handle; keeps the last value where the field has none.
void update_level(const Spec& spec, State& state) noexcept;

}  // namespace catena::widget
