// SPDX-License-Identifier: MIT
/// Rotational chain: each link with "align" has a rotational proxy beside its positional proxy, toward which it turns the tool.
///   q_0: orientation of the tool;  q_i = A q_(i-1), with A the smallest rotation that turns the tool's axis q_(i-1) a_i onto n_i
///   n_i: axis of the link's primitive at its proxy (normal of a plane, tangent of a line). Sign::either: the nearer of +-n_i at first,
///        then the same one until the tool's axis is more than 10 degrees past perpendicular to it
///   torque = sum w_i kappa_i log(q_i q_(i-1)^-1) + ramp offset - b_r omega,  omega = log(q_0(t) q_0(t - dt)^-1) / dt
/// The ramp is that of ramp.h, with moved = sum kappa_i |omega dt| and fall = sum kappa_i (pi / 2) dt / ramp_s.
/// kappa_i is capped by the device's limit (constraint.h). Where the link does not constrain its probe, or has no axis, q_i = q_(i-1).
/// The spring of one link has the energy 1/2 kappa angle^2: while n_i is at rest it returns the energy that was put in. Where the axis
/// changes its end (perpendicular to n_i for `either`, opposite to it for `same`) the torque changes its sign; it never exceeds
/// kappa (pi/2 + 10 degrees) or kappa pi.
/// Finding n_i may cost a field sample, which is counted; at the limit of samples the last n_i is kept. N m, radians, world axes; the log
/// of a rotation uses libm. Haptic thread: no allocation, lock, throw. Nothing is computed without a link that aligns and without b_r.
#pragma once
#include <span>

#include "engine/base/export.h"
#include "haptics/chain/ramp.h"
#include "haptics/chain/switching.h"

namespace catena::haptics {

/// State of the rotational chain between ticks.
struct AlignmentState {
  std::array<Vec3, kMaxLinks> axes{};        ///< n_i of the last tick, with the sign toward which the tool is turned; zero: none
  Ramp ramp;                                 ///< ramp of the torque
  double total_stiffness = 0;                ///< sum of kappa_i used by the ramp, N m/rad
  Quat last_orientation{kIdentityRotation};  ///< orientation of the tool in the last tick
  /// Rotational proxies of the last tick, reported in ticks without a pose.
  std::array<Quat, kMaxLinks> rotational_proxies = [] {
    std::array<Quat, kMaxLinks> none;
    none.fill(kIdentityRotation);
    return none;
  }();
};

/// Timing of one step of the rotational chain.
struct AlignmentStep {
  bool first_tick = false;  ///< no earlier tick had a probe
  double dt_s = 0;          ///< time since the last tick with a probe, seconds
  double ramp_step = 1;     ///< dt / ramp_s; 1 or more: no ramp
};

/// Steps the rotational chain, after the positional chain of this tick. Returns the torque requested by the links and the rotational
/// damping; sets every link's orientation and torque in `out`.
CATENA_EXPORT Vec3 align_links(const HapticProgram& program, const LinkOrder& order, const Quat& tool, const AlignmentStep& step,
                               std::span<LinkState> links, std::span<LinkScratch> scratch, AlignmentState& state,
                               HapticState& out) noexcept;

}  // namespace catena::haptics
