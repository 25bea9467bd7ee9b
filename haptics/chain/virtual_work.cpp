// SPDX-License-Identifier: MIT
#include "haptics/chain/virtual_work.h"

namespace catena::haptics {

namespace {

constexpr double kDifference = 1e-6;  // step of the finite difference for a stiffness gradient, as a fraction of L

}  // namespace

PulledBackForce virtual_work_force(const HapticProgram& program, const LinkOrder& order, const Vec3& probe,
                                   const std::array<Vec3, kMaxLinks>& gaps, const std::array<Vec3, kMaxLinks>& shares_n,
                                   std::array<LinkState, kMaxLinks>& links, std::array<LinkScratch, kMaxLinks>& scratch) noexcept {
  PulledBackForce all;
  for (int k = order.count - 1; k >= 0; --k) {
    const auto i = static_cast<std::size_t>(order.links[static_cast<std::size_t>(k)]);
    const Link& spec = program.links[i];
    // a stiffness that depends on a field pulls the proxy toward lower stiffness
    if (!spec.stiffness_n_per_m.is_constant()) {
      const Vec3 slope = spec.stiffness_n_per_m.gradient(links[i].proxy, kDifference * spec.constraint->domain_length(),
                                                         scratch[i].stiffness_cursor, links[i].evaluations);
      all.force -= slope * (0.5 * links[i].weight * program.meters_per_unit * dot(gaps[i], gaps[i]));
    }
    if (max_abs(all.force) > 0 || max_abs(all.truncated) > 0) {
      const int before = k > 0 ? order.links[static_cast<std::size_t>(k - 1)] : -1;
      const Vec3& incoming = before < 0 ? probe : links[static_cast<std::size_t>(before)].proxy;
      const PulledBackForce force = spec.constraint->pull_back(incoming, all.force, links[i], scratch[i]);
      const Vec3 left_out =
          max_abs(all.truncated) > 0 ? spec.constraint->pull_back(incoming, all.truncated, links[i], scratch[i]).force : Vec3(0.0);
      all = {force.force, force.truncated + left_out};
    }
    all.force += shares_n[i];
  }
  return all;
}

void accumulate_unaccounted(UnaccountedEnergy& state, const PulledBackForce& force, double energy_j, const Vec3& move_m) noexcept {
  const Vec3 total_force = force.force + force.truncated;
  if (state.has_previous) {
    const double jump = state.energy_j - energy_j - 0.5 * dot(state.force_n + total_force, move_m);
    const Vec3 turned = total_force - state.force_n;
    const double missed2 = dot(turned, turned) * dot(move_m, move_m);
    state.work_j += 0.5 * dot(state.truncated_n + force.truncated, move_m) + (jump * jump > missed2 ? jump : 0);
  }
  state.force_n = total_force;
  state.truncated_n = force.truncated;
  state.energy_j = energy_j;
  state.has_previous = std::isfinite(energy_j) && is_finite(total_force);
}

}  // namespace catena::haptics
