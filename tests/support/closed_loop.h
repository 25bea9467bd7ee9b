/// A simulated hand on the very tick, without a thread: read, tick, write. And what the hand has got, by an account of its own.
#pragma once
#include <algorithm>
#include <memory>

#include "haptics/chain/tick.h"
#include "haptics/device/simulated_hand.h"
#include "haptics/servo/step.h"

namespace catena::test {

struct ClosedLoop {
  ClosedLoop(const haptics::Program& p, const haptics::HandParameters& parameters,
             std::vector<haptics::SimulatedHand::Waypoint> path = {{}})
      : program(&p), hand(std::move(path), parameters), mechanics(hand.capabilities().mechanics), period_s(parameters.period_s) {}

  const exchange::HapticState& step() {
    const haptics::DeviceInput input = hand.read();
    const Vec3 probe = haptics::world_from_device(*program, input.position_m);
    haptics::tick(*program, {static_cast<double>(ticks) * period_s, probe, input.buttons, kNoRotation, condition, forces_on}, *state,
                  *scratch, out);
    // energy that has left towards the hand, and what the mechanism's damping has taken, true positions
    const Vec3 moved = hand.position_m() - last_m;
    if (ticks > 0) {
      given_j += dot(sent_n, moved);
      damped_j += mechanics.damping_ns_per_m * dot(moved, moved) / period_s;
    }
    last_m = hand.position_m();
    sent_n = out.force_n;
    least_j = std::min(least_j, damped_j - given_j);
    hand.write({out.force_n, out.torque_nm});
    ++ticks;
    return out;
  }
  void run(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  void take(const haptics::Program& next) {
    haptics::rebind(*program, next, *state, *scratch);
    program = &next;
  }
  double kinetic_j() const { return 0.5 * mechanics.mass_kg * dot(hand.velocity_m_per_s(), hand.velocity_m_per_s()); }

  const haptics::Program* program;
  haptics::SimulatedHand hand;
  haptics::Mechanics mechanics;
  double period_s;
  haptics::Condition condition = haptics::Condition::normal;
  bool forces_on = true;
  std::unique_ptr<haptics::ChainState> state = std::make_unique<haptics::ChainState>();
  std::unique_ptr<haptics::ChainScratch> scratch = std::make_unique<haptics::ChainScratch>();
  exchange::HapticState out;
  std::uint64_t ticks = 0;
  Vec3 last_m{0.0}, sent_n{0.0};
  double given_j = 0, damped_j = 0;
  double least_j = 0;  ///< of E + int b v^2
};

}  // namespace catena::test
