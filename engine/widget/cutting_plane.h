// SPDX-License-Identifier: MIT
/// The cutting plane widget (paper, section 6.2, Figure 6). Notation: c center, e_i axes, e_2 normal, r radius of the sphere, x probe.
/// Lists in brackets are the links of the chain in that mode.
///   near the plane     |e_2 . (x - c)| <= snap; in mode explore <= release
///   near the sphere    | |x - c| - r | <= grab_distance
///   near the arrow     |x - (c + t e_2)| <= grab_distance for a t from 0 to kArrowLength r, where neither plane nor sphere is near; the
///                      arrow is handle 0
///   hover              [plane x, plane y]: the probe is attracted to the arrow's line
///   drag               as translate, but the planes across e_0 and e_1 always hold: the plane moves along its normal
///   explore            [plane z]
///   translate          planes of a Grip across e_i
///   rotate             [planes through c with |e_i . (x - c)| <= grab_distance, sphere]   (no planes with RotationMode::free)
///   turn about e_i     [plane i, sphere];  R = (rotation about e_i from the first arm to the current one) R_press: exact for any angle;
///                      with RotationMode::any plane i releases the probe at |e_i . (x - c)| > step, and the widget turns freely until
///                      the button is released
///   turn freely        [sphere];  R = (smallest rotation from the last arm to the current one) R, which continues from the last R
/// An arm is the direction from c to the proxy, within plane i when turning about e_i. Haptic thread: no allocation, lock, throw.
#pragma once
#include "engine/widget/handles.h"

namespace catena::widget {

inline constexpr double kArrowLength = 1.45;  ///< Length of the arrow along the normal, from the center, in radii of the sphere.

/// Returns whether the probe is near the arrow, the sphere or the plane.
Proximity plane_proximity(const Spec& spec, const State& state, const Vec3& probe) noexcept;
/// Starts mode turn: chooses the axis whose great circle is nearest to the probe, or none for turning freely.
void begin_turn(const Spec& spec, State& state, const Vec3& probe) noexcept;
/// Returns the links for the current mode; may switch a turn about an axis to a free one.
ChainRequest plan_plane_chain(const Spec& spec, State& state, const Vec3& probe) noexcept;
/// Updates the pose in modes translate, turn and drag from the last proxy of the chain.
void update_plane_pose(const Spec& spec, State& state, const Vec3& proxy) noexcept;

}  // namespace catena::widget
