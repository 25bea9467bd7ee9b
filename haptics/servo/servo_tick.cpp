// SPDX-License-Identifier: MIT
#include "haptics/servo/servo_tick.h"

namespace catena::haptics {

Vec3 world_from_device(const HapticProgram& program, const Vec3& device_m) noexcept {
  return program.workspace_origin + program.workspace_rotation * device_m * (1 / program.meters_per_unit);
}

Vec3 device_from_world(const HapticProgram& program, const Vec3& world) noexcept {
  return ((world - program.workspace_origin) * program.workspace_rotation) * program.meters_per_unit;  // v * R = R^T v
}

ProbeSample make_probe_sample(const HapticProgram& program, const DeviceInput& input, double t_s) noexcept {
  // a recorded path, including its orientation, is already in world coordinates
  ProbeSample probe;
  probe.buttons = input.buttons;
  probe.t_s = input.is_recorded ? input.t_s : t_s;
  probe.position = input.is_recorded ? input.position_m : world_from_device(program, input.position_m);
  probe.orientation = input.is_recorded ? input.orientation : glm::quat_cast(program.workspace_rotation) * input.orientation;
  probe.forces_on = input.forces_on;
  return probe;
}

DeviceOutput make_device_output(const HapticProgram& program, const HapticState& state, const ChainState& chain) noexcept {
  const bool live = state.force_state != ForceState::off && state.force_state != ForceState::stopped;
  double booked_j = 0;
  for (std::size_t i = 0; i < program.links.size(); ++i) booked_j += state.links[i].accounted_j;
  return {.force_n = state.force_n * program.workspace_rotation,
          .torque_nm = state.torque_nm * program.workspace_rotation,
          .forces_active = live,
          .accounted_j = booked_j,
          .requested_force_n = chain.requested_force_n * program.workspace_rotation};
}

ServoStepper::ServoStepper(Device& device, const HapticProgram& program, double rate_hz, TickSink* sink)
    : device_(device), program_(program), rate_hz_(rate_hz), sink_(sink) {
  device_.resume();
}

const HapticState& ServoStepper::step() {
  const DeviceInput input = device_.read();
  ProbeSample probe = make_probe_sample(program_, input, t_s());
  probe.condition = input.status == DeviceStatus::ready ? TickCondition::normal : TickCondition::no_device;
  runner_.run(program_, probe, *state_, *scratch_, out_);
  device_.write(make_device_output(program_, out_, *state_));
  ++ticks_;
  if (sink_ != nullptr) sink_->put(probe, out_);
  return out_;
}

}  // namespace catena::haptics
