// SPDX-License-Identifier: MIT
/// A simulated hand in the real tick without a thread (read, tick, write), and an independent account of the energy given to the hand.
#pragma once
#include <algorithm>
#include <memory>

#include "haptics/chain/tick.h"
#include "haptics/device/simulated_device.h"
#include "haptics/servo/servo_tick.h"

namespace catena::test {

struct ClosedLoop {
  ClosedLoop(const haptics::HapticProgram& p, const haptics::SimulatedDeviceParameters& parameters,
             std::vector<haptics::SimulatedDevice::Waypoint> path = {{}})
      : program(&p), device(std::move(path), parameters), mechanics(device.capabilities().mechanics), period_s(parameters.period_s) {}

  const HapticState& step() {
    const haptics::DeviceInput input = device.read();
    const Vec3 probe = haptics::world_from_device(*program, input.position_m);
    haptics::tick(*program, {static_cast<double>(ticks) * period_s, probe, input.buttons, kIdentityRotation, condition, forces_on}, *state,
                  *scratch, out);
    // energy given to the device, and energy dissipated by the mechanism's damping, by true positions
    const Vec3 moved = device.position_m() - last_position_m;
    if (ticks > 0) {
      energy_to_device_j += dot(last_force_n, moved);
      energy_damped_j += mechanics.damping_ns_per_m * dot(moved, moved) / period_s;
    }
    last_position_m = device.position_m();
    last_force_n = out.force_n;
    min_passivity_j = std::min(min_passivity_j, energy_damped_j - energy_to_device_j);
    device.write({out.force_n, out.torque_nm});
    ++ticks;
    return out;
  }
  void run(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  void switch_program(const haptics::HapticProgram& next) {
    haptics::rebind_program(*program, next, *state, *scratch);
    program = &next;
  }
  double kinetic_j() const { return 0.5 * mechanics.mass_kg * dot(device.velocity_m_per_s(), device.velocity_m_per_s()); }

  const haptics::HapticProgram* program;
  haptics::SimulatedDevice device;
  haptics::Mechanics mechanics;
  double period_s;
  catena::TickCondition condition = catena::TickCondition::normal;
  bool forces_on = true;
  std::unique_ptr<haptics::ChainState> state = std::make_unique<haptics::ChainState>();
  std::unique_ptr<haptics::ChainScratch> scratch = std::make_unique<haptics::ChainScratch>();
  HapticState out;
  std::uint64_t ticks = 0;
  Vec3 last_position_m{0.0}, last_force_n{0.0};
  double energy_to_device_j = 0, energy_damped_j = 0;
  double min_passivity_j = 0;  ///< minimum of E + int b v^2
};

}  // namespace catena::test
