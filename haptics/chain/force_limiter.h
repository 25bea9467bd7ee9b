// SPDX-License-Identifier: MIT
/// Force limiter, the last step of a tick: computes the commanded force from the chain force. A pure function of (limits, input, state).
/// The first of these cases that applies decides; the right column is the resulting ForceState:
///   fault    no device, watchdog, or a force that is not finite: zero in the same tick                          STOPPED
///   off      switched off by the user or the device: the chain force, ramped to zero linearly over ramp_out_s,  RAMPING_OUT, OFF
///            never larger than in the preceding tick
///   late     up to max_late_ticks in a row: the last force is held                                              HELD
///            more: the held force is ramped to zero linearly over ramp_out_s                                    RAMPING_OUT, STOPPED
///   normal   the chain force; in the first tick and after each of the cases above it is scaled by a factor      RAMPING_IN, ON
///            that rises linearly to 1 in ramp_in_s, starting from the value that the ramp out left
/// A normal force is then limited: |F| and |torque| with the direction kept, then |F - last F| <= slew dt. The slew limit never delays a
/// drop to zero. The tick in which a ramp begins counts with its dt. If the clock stands still, a ramp out still ends within 1000 ticks.
/// With default limits and normal ticks the force passes unchanged, bit for bit. Haptic thread.
#pragma once
#include "engine/base/export.h"
#include "engine/base/haptic_state.h"
#include "haptics/chain/constraint.h"

namespace catena::haptics {

/// State of the force limiter between ticks, and its result. World axes.
struct ForceLimiterState {
  Vec3 force_n{0.0};                        ///< commanded force of the last tick
  Vec3 torque_nm{0.0};                      ///< commanded torque of the last tick
  Vec3 held_force_n{0.0};                   ///< force at the first late tick of the row
  Vec3 held_torque_nm{0.0};                 ///< torque at the first late tick of the row
  double ramp_factor = 0;                   ///< 0..1: fraction of the chain force that passes
  double hold_factor = 1;                   ///< 1..0: fraction of the held force that passes
  int late_ticks = 0;                       ///< number of late ticks in a row
  ForceState force_state = ForceState::on;  ///< state that is reported
};

/// Input of the force limiter in one tick. World axes.
struct ForceLimiterInput {
  Vec3 force_n{0.0}, torque_nm{0.0};                ///< chain force and torque
  TickCondition condition = TickCondition::normal;  ///< condition of the tick
  bool forces_on = true;                            ///< the user's force switch and the device's own switch are both on
  double dt_s = 0;                                  ///< time since the last tick, seconds
};

/// Steps the limiter: sets state.force_n, torque_nm and force_state to the commanded force of this tick.
CATENA_EXPORT void limit_force(const DeviceLimits& limits, const ForceLimiterInput& input, ForceLimiterState& state) noexcept;

/// Returns `v` shortened to the length `max_norm` with the direction kept, or `v` itself if it is not longer. `v` must be finite.
CATENA_EXPORT Vec3 clamp_norm(const Vec3& v, double max_norm) noexcept;

}  // namespace catena::haptics
