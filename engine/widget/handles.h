/// A translation of a widget (widget.h, Grip): planes across the axes of a frame, through the place where the hand took it.
/// World units. Haptic thread: no allocation, lock, throw.
#pragma once
#include "engine/widget/widget.h"

namespace catena::widget {

/// Adds the planes that hold a probe here; sets state.held.
void add_planes(const Spec& spec, State& state, const Vec3& probe, ChainRequest& plan) noexcept;
/// How far the widget has moved along each axis of the frame: exactly 0 where it is held.
Vec3 displacement(const Spec& spec, const State& state, const Vec3& proxy) noexcept;
/// The same in world axes: what does not move adds nothing, to the bit.
Vec3 translated(const Vec3& from, const Quat& frame, const Vec3& displacement) noexcept;

/// What of a widget a probe is near. World units.
struct Proximity {
  std::int8_t nearest_handle = -1;  ///< the handle; -1: none
  bool near_sphere = false;
  bool near_plane = false;
  double distance = 0;  ///< from the nearest of these
};

/// The widgets that are held by handles: seed, rake, isolevel, box, ruler. x the probe, h a handle.
///   hover   |x - h| <= near, the nearest handle (the one that has the probe keeps it as long as that holds): [point at h]
///   drag    the planes of a Grip:
///     seed, ends and middle of rake and ruler, the box's centre: across the pose's axes, each lets go at `step`
///     a face of the box: the two planes along its normal stay, the face moves with the probe; the faces keep a least distance, `step`
///     or what they had when that is less
///     isolevel: the two planes along the gradient stay, the handle moves with the probe; where there is no gradient, as a seed
///     an end of a ruler with `along`: those links of the scene; the end is their last proxy
int handle_count(Kind kind) noexcept;  ///< 0: a cutting plane
/// WidgetReport says which is which.
Vec3 handle_position(Kind kind, const Pose& pose, int handle) noexcept;

Proximity handle_proximity(const Spec& spec, const State& state, const Vec3& probe) noexcept;
Grip make_grip(const Spec& spec, const State& state, const Vec3& probe) noexcept;
ChainRequest plan_handle_chain(const Spec& spec, State& state, const Vec3& probe) noexcept;
void update_handle_pose(const Spec& spec, State& state, const Vec3& proxy) noexcept;
/// An isolevel's value: the field's at the handle; outside the field the last one stays.
void update_level(const Spec& spec, State& state) noexcept;

}  // namespace catena::widget
