#include "haptics/servo/step.h"

namespace catena::haptics {

Vec3 world_from_device(const Program& program, const Vec3& device_m) noexcept {
  return program.workspace_origin + program.workspace_rotation * device_m * (1 / program.metres_per_unit);
}

Vec3 device_from_world(const Program& program, const Vec3& world) noexcept {
  return ((world - program.workspace_origin) * program.workspace_rotation) * program.metres_per_unit;  // v * R = R^T v
}

ProbeSample probe_of(const Program& program, const DeviceInput& input, double t_s) noexcept {
  // a recorded path is in the world already, and so is its orientation
  ProbeSample probe;
  probe.buttons = input.buttons;
  probe.t_s = input.recorded ? input.t_s : t_s;
  probe.position = input.recorded ? input.position_m : world_from_device(program, input.position_m);
  probe.orientation = input.recorded ? input.orientation : glm::quat_cast(program.workspace_rotation) * input.orientation;
  probe.forces_on = input.forces_on;
  return probe;
}

DeviceOutput output_of(const Program& program, const exchange::HapticState& state, const ChainState& chain) noexcept {
  const bool live = state.force_state != exchange::ForceState::off && state.force_state != exchange::ForceState::stopped;
  double booked_j = 0;
  for (std::size_t i = 0; i < program.links.size(); ++i) booked_j += state.links[i].booked_j;
  return {.force_n = state.force_n * program.workspace_rotation,
          .torque_nm = state.torque_nm * program.workspace_rotation,
          .live = live,
          .booked_j = booked_j,
          .told_n = chain.told_n * program.workspace_rotation};
}

Stepper::Stepper(Device& device, const Program& program, double rate_hz, TickSink* sink)
    : device_(device), program_(program), rate_hz_(rate_hz), sink_(sink) {
  device_.resume();
}

const exchange::HapticState& Stepper::step() noexcept {
  const DeviceInput input = device_.read();
  ProbeSample probe = probe_of(program_, input, t_s());
  probe.condition = input.status == DeviceStatus::ready ? Condition::normal : Condition::no_device;
  tick(program_, probe, *state_, *scratch_, out_);
  device_.write(output_of(program_, out_, *state_));
  ++ticks_;
  if (sink_ != nullptr) sink_->put(probe, out_);
  return out_;
}

}  // namespace catena::haptics
