/// The rotational chain: where a link has "align", it keeps beside its proxy a rotational one, and turns the hand towards it.
///   q_0: the tool's orientation;  q_i = A q_(i-1),  A the smallest rotation that turns the tool's axis q_(i-1) a_i onto n_i
///   n_i: the axis of the link's primitive at its proxy (the normal of a plane, the tangent of a line); "either": of +-n_i the nearer
///        one at first, then the same one until the tool's axis is 10 degrees past square to it
///   torque = sum w_i kappa_i log(q_i q_(i-1)^-1) + what the ramp holds back - b_r omega,  omega = log(q_0(t) q_0(t - dt)^-1) / dt
/// The ramp is that of ramp.h, with moved = sum kappa_i |omega dt| and fall = sum kappa_i (pi / 2) dt / ramp_s.
/// kappa_i is at most the device's (constraint.h). Where the positional proxy lets its probe through, or there is no axis, q_i = q_(i-1).
/// The spring of one link has the energy 1/2 kappa angle^2: it gives back what it took while n_i rests; at the ridge (the axis past square
/// to n_i for "either", opposite to it for "same") the torque turns over, but never exceeds kappa (pi/2 + 10 degrees) or kappa pi.
/// Asking for n_i may cost a field fetch, which counts; at the cap the last n_i is kept. N m, radians, world axes; log of angles uses
/// libm. Haptic thread: no allocation, lock, throw. Without a link that aligns and without b_r nothing is computed.
#pragma once
#include <span>

#include "haptics/chain/ramp.h"
#include "haptics/chain/switching.h"

namespace catena::haptics {

/// What the rotational chain remembers.
struct AlignmentState {
  std::array<Vec3, kMaxLinks> axes{};        ///< n_i of the last tick, by the end that draws the tool; zero: none
  Ramp ramp;                                 ///< of the torque
  double total_stiffness = 0;                ///< sum of kappa_i that the ramp goes by, N m/rad
  Quat last_orientation{kIdentityRotation};  ///< the tool's orientation in the last tick
  /// The rotational proxies as the last tick left them, for ticks without a pose.
  std::array<Quat, kMaxLinks> rotational_proxies = [] {
    std::array<Quat, kMaxLinks> none;
    none.fill(kIdentityRotation);
    return none;
  }();
};

/// What a tick tells it.
struct AlignmentStep {
  bool first_tick = false;  ///< there was no tick before
  double dt_s = 0;          ///< since the last tick, seconds
  double ramp_step = 1;     ///< dt / ramp_s; 1 or more: at once
};

/// After the chain of this tick. Returns the torque that the links ask for; fills every link's orientation and torque in `out`.
Vec3 align_links(const HapticProgram& program, const LinkOrder& order, const Quat& tool, const AlignmentStep& step,
                 std::span<LinkState> links, std::span<LinkScratch> scratch, AlignmentState& state, HapticState& out) noexcept;

}  // namespace catena::haptics
