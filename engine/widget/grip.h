/// A translation of a widget (state.h, Grip): planes across the axes of a frame, through the place where the hand took it.
/// World units. Haptic thread: no allocation, lock, throw.
#pragma once
#include "engine/widget/state.h"

namespace catena::widget {

/// Adds the planes that hold a probe here; sets state.held.
void add_planes(const Spec& spec, State& state, const Vec3& probe, Plan& plan) noexcept;
/// How far the widget has moved along each axis of the frame: exactly 0 where it is held.
Vec3 displacement(const Spec& spec, const State& state, const Vec3& proxy) noexcept;
/// The same in world axes: what does not move adds nothing, to the bit.
Vec3 moved(const Vec3& from, const Quat& frame, const Vec3& displacement) noexcept;

}  // namespace catena::widget
