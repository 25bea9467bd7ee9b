/// The last step of a tick: what the chain asks for -> what the hand gets. A pure function of (limits, input, state).
///   fault    no device, watchdog, a force that is not finite: zero in this very tick                           STOPPED
///   late     up to max_late_ticks in a row: the last force                                                         HELD
///            more: from that force to zero, linearly over ramp_out_s                                RAMPING_OUT, STOPPED
///   off      switched off by a person: the chain's force to zero, linearly over ramp_out_s,             RAMPING_OUT, OFF
///            never more than in the tick before
///   normal   the chain's force; from the first tick on, and after each of the above, times a factor that rises
///            linearly to 1 in ramp_in_s (from where a ramp out has left it)                              RAMPING_IN, ON
/// A normal force is then limited: |F| and |torque|, direction kept, then |F - last F| <= slew dt. The slew limit never delays
/// the way to zero. The tick at which the ramps begin counts with its dt; a clock that stands still ends a ramp out all the
/// same, within 1000 ticks. With default limits and normal ticks it changes nothing, to the bit. Haptic thread.
#pragma once
#include "engine/base/haptic_state.h"
#include "haptics/chain/constraint.h"

namespace catena::haptics {

/// What the guard remembers, and what it lets through.
struct ForceLimiterState {
  Vec3 force_n{0.0};                        ///< the last one that was sent
  Vec3 torque_nm{0.0};                      ///< the last one that was sent
  Vec3 held_force_n{0.0};                   ///< at the first of the late ticks
  Vec3 held_torque_nm{0.0};                 ///< at the first of the late ticks
  double ramp_factor = 0;                   ///< 0..1: the part of the chain's force that is let through
  double hold_factor = 1;                   ///< 1..0: the part of what is held
  int late_ticks = 0;                       ///< ticks in a row
  ForceState force_state = ForceState::on;  ///< what became of the force
};

/// What the guard looks at, beside its state. World axes, newtons.
struct ForceLimiterInput {
  Vec3 force_n{0.0}, torque_nm{0.0};                ///< what the chain asks for
  TickCondition condition = TickCondition::normal;  ///< how the tick came about
  bool forces_on = true;                            ///< the person's switch and the device's
  double dt_s = 0;                                  ///< since the last tick, seconds
};

/// Sets state.force_n, torque_nm, force_state: what the hand gets in this tick.
void limit_force(const DeviceLimits& limits, const ForceLimiterInput& input, ForceLimiterState& state) noexcept;

/// `v` no longer than `most`, direction kept; itself where it is not longer. `v` is finite.
Vec3 clamp_norm(const Vec3& v, double most) noexcept;

}  // namespace catena::haptics
