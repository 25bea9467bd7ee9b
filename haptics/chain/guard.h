/// The last step of a tick: what the chain asks for -> what the hand gets. A pure function of (limits, probe, state).
///   lost device, watchdog, a force that is not finite: zero in this tick;  late: the last force, then a ramp to zero
///   switched off: zero;  switched on: a ramp;  then passivity, slew and magnitude limits
/// With default limits and normal ticks it changes nothing, to the bit. Haptic thread.
#pragma once
#include "engine/exchange/haptic_state.h"
#include "haptics/chain/limits.h"

namespace catena::haptics {

using exchange::Condition;
using exchange::ForceState;

struct GuardState {
  Vec3 force_n{0.0};  ///< the last one that was sent
  Vec3 torque_nm{0.0};
  ForceState force_state = ForceState::on;
};

/// What the guard looks at, beside its state. World axes, newtons.
struct GuardInput {
  Vec3 force_n{0.0}, torque_nm{0.0};  ///< what the chain asks for
  Condition condition = Condition::normal;
  bool forces_on = true;
  double dt_s = 0;
};

/// Sets state.force_n, torque_nm, force_state: what the hand gets in this tick.
void guard(const Limits& limits, const GuardInput& input, GuardState& state) noexcept;

}  // namespace catena::haptics
