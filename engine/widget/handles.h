/// The widgets that are held by handles: seed, rake, isolevel, box, ruler. x the probe, h a handle.
///   hover   |x - h| <= near, the nearest handle (the one that has the probe keeps it as long as that holds): [point at h]
///   drag    the planes of a Grip:
///     seed, ends and middle of rake and ruler, the box's centre: across the pose's axes, each lets go at `step`
///     a face of the box: the two planes along its normal stay, the face moves with the probe; the faces keep a least distance, `step`
///     or what they had when that is less
///     isolevel: the two planes along the gradient stay, the handle moves with the probe; where there is no gradient, as a seed
///     an end of a ruler with `along`: those links of the scene; the end is their last proxy
#pragma once
#include "engine/widget/reach.h"

namespace catena::widget {

int handle_count(Kind kind) noexcept;  ///< 0: a cutting plane
/// WidgetReport says which is which.
Vec3 handle_position(Kind kind, const Pose& pose, int handle) noexcept;

Reach reach_of_handles(const Spec& spec, const State& state, const Vec3& probe) noexcept;
Grip grip_of(const Spec& spec, const State& state, const Vec3& probe) noexcept;
Plan plan_of_handles(const Spec& spec, State& state, const Vec3& probe) noexcept;
void finish_handles(const Spec& spec, State& state, const Vec3& proxy) noexcept;
/// An isolevel's value: the field's at the handle; outside the field the last one stays.
void read_level(const Spec& spec, State& state) noexcept;

}  // namespace catena::widget
