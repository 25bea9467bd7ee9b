// SPDX-License-Identifier: MIT
/// Conservative force of a chain (CouplingForce::conservative), by virtual work. The paper's sum of the links' forces is not the gradient
/// of any energy: along slow closed loops of the probe it gives or takes 0.7 K gap^2 per loop (a plane and a line). With
///   E = 1/2 sum w_i k_i |S (p_i - p_(i-1))|^2,   p_i = P_i(p_(i-1)),   g_i = w_i k_i S (p_i - p_(i-1)),   J_i = dP_i at p_(i-1)
///   F = -dE/dx = g_1 + J_1^T (g_2 + h_1 + J_2^T (g_3 + h_2 + ...)),   h_i = -1/2 w_i S |p_i - p_(i-1)|^2 grad k_i
/// each link's force is pulled back through the projections before it (Constraint::pull_back). Links that are no projections (friction,
/// forces) pass it on unchanged; torques (alignment.h) are the paper's. k_i is evaluated at the proxy of this tick, so that E is a function
/// of x. Newtons, world axes. Haptic thread: no allocation, lock or throw.
#pragma once
#include "engine/base/export.h"
#include "haptics/chain/switching.h"

namespace catena::haptics {

/// Part of the energy that F does not account for: over a closed loop, the work done on the user and this part sum to zero. It consists of
///   the truncated part of the pull-back (bounds of J), integrated over the path of the probe by the trapezoid rule, and
///   the difference between the change of E and -(F + truncated) dx, in ticks where it exceeds what the trapezoid rule may miss,
///   |d(F + truncated)| |dx|: a proxy that jumps (to the next straight segment at a concave corner, to another point that is equally near),
///   a link that is released or switched, friction
struct UnaccountedEnergy {
  Vec3 force_n{0.0};          ///< -dE/dx of the last tick, without bounds of J
  Vec3 truncated_n{0.0};      ///< part of force_n that the bounds of J truncate
  double energy_j = 0;        ///< E of the last tick
  double work_j = 0;          ///< unaccounted energy since the start, joules
  bool has_previous = false;  ///< the values of the last tick are valid
};

/// Returns F, after the links of this tick have advanced. `gaps` and `shares_n` are p_i - p_(i-1) (world units) and g_i (newtons) by link.
CATENA_EXPORT PulledBackForce virtual_work_force(const HapticProgram& program, const LinkOrder& order, const Vec3& probe,
                                                 const std::array<Vec3, kMaxLinks>& gaps, const std::array<Vec3, kMaxLinks>& shares_n,
                                                 std::array<LinkState, kMaxLinks>& links,
                                                 std::array<LinkScratch, kMaxLinks>& scratch) noexcept;

/// Adds the unaccounted energy of one tick. `force`: result of virtual_work_force; `energy_j`: E; `move_m`: probe travel of the tick,
/// meters.
CATENA_EXPORT void accumulate_unaccounted(UnaccountedEnergy& state, const PulledBackForce& force, double energy_j,
                                          const Vec3& move_m) noexcept;

}  // namespace catena::haptics
