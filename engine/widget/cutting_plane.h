/// The cutting plane (paper, section 6.2, Figure 6): c its centre, e_i its axes, e_2 the normal, r the sphere's radius, x the probe.
///   near the plane     |e_2 . (x - c)| <= snap, or <= release while it explores
///   near the sphere    | |x - c| - r | <= near
///   explore            [plane z]
///   translate          the planes of a Grip across e_i
///   rotate             [planes through c with |e_i . (x - c)| <= near, sphere]       (none where it turns freely only)
///   turn about e_i     [plane i, sphere];  R = turn about e_i of the press, from its arm to this one, R_press: exact, however far
///                      the plane lets go at |e_i . (x - c)| > step (RotationMode::any), until the hand lets go
///   turn freely        [sphere];  R = (smallest rotation from the last arm to this one) R, so that it goes on from where it was
/// An arm is the direction from c to the proxy, in the plane where there is one.
#pragma once
#include "engine/widget/handles.h"

namespace catena::widget {

Proximity plane_proximity(const Spec& spec, const State& state, const Vec3& probe) noexcept;
void begin_turn(const Spec& spec, State& state, const Vec3& probe) noexcept;
ChainRequest plan_plane_chain(const Spec& spec, State& state, const Vec3& probe) noexcept;
void update_plane_pose(const Spec& spec, State& state, const Vec3& proxy) noexcept;

}  // namespace catena::widget
