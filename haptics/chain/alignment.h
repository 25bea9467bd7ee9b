/// The rotational chain: where a link has "align", it keeps beside its proxy a rotational one, and turns the hand towards it.
///   q_0: the tool's orientation;  q_i = A q_(i-1),  A the smallest rotation that turns the tool's axis q_(i-1) a_i onto n_i
///   n_i: the axis of the link's primitive at its proxy (the normal of a plane, the tangent of a line); "either": the nearer of +-n_i
///   torque = sum w_i kappa_i log(q_i q_(i-1)^-1) + what fades after a switch - b_r omega,  omega = log(q_0(t) q_0(t - dt)^-1) / dt
/// kappa_i is at most the device's (constraint.h). Where the positional proxy lets its probe through, or there is no axis, q_i = q_(i-1).
/// The spring of one link has the energy 1/2 kappa angle^2: it gives back what it took while n_i rests; at the ridge (the axis square
/// to n_i for "either", opposite to it for "same") the torque turns over, but never exceeds kappa pi/2 or kappa pi.
/// Asking for n_i may cost a field fetch, which counts; at the cap the last n_i is kept. N m, radians, world axes; log of angles uses
/// libm. Haptic thread: no allocation, lock, throw. Without a link that aligns and without b_r nothing is computed.
#pragma once
#include <span>

#include "haptics/chain/switching.h"

namespace catena::haptics {

/// What the rotational chain remembers.
struct AlignmentState {
  std::array<Vec3, kMaxLinks> axes{};  ///< n_i of the last tick; zero: none
  Fade fade;                           ///< of torques
  Quat last{kNoRotation};              ///< the tool's orientation in the last tick
  bool engaged = false;                ///< there was a link that aligns
  /// The rotational proxies as the last tick left them, for ticks without a pose.
  std::array<Quat, kMaxLinks> links = [] {
    std::array<Quat, kMaxLinks> none;
    none.fill(kNoRotation);
    return none;
  }();
};

/// What a tick tells it.
struct AlignmentStep {
  bool first_tick = false;  ///< there was no tick before
  double dt_s = 0;          ///< since the last tick, seconds
  double ramp_step = 1;     ///< as in step_fade()
};

/// After the chain of this tick. Returns the torque that the links ask for; fills every link's orientation and torque in `out`.
Vec3 align_links(const Program& program, const Order& order, const Quat& tool, const AlignmentStep& step, std::span<LinkState> links,
                 std::span<LinkScratch> scratch, AlignmentState& state, exchange::HapticState& out) noexcept;

}  // namespace catena::haptics
