#include "haptics/chain/guard.h"

namespace catena::haptics {

void guard(const Limits& limits, const GuardInput& input, GuardState& state) noexcept {
  (void)limits;
  const bool stopped = input.condition == Condition::no_device || input.condition == Condition::watchdog;
  state.force_state = stopped ? ForceState::stopped : input.forces_on ? ForceState::on : ForceState::off;
  const bool flows = state.force_state == ForceState::on;
  state.force_n = flows ? input.force_n : Vec3(0.0);
  state.torque_nm = flows ? input.torque_nm : Vec3(0.0);
}

}  // namespace catena::haptics
