/// The conservative force of a chain (coupling.force), by virtual work. The paper's sum of pulls is not the gradient of any energy: along
/// slow closed loops of the hand it gives or takes 0.7 K gap^2 a loop (a plane and a line). With
///   E = 1/2 sum k_i |S (p_i - p_(i-1))|^2,   p_i = P_i(p_(i-1)),   g_i = w_i k_i S (p_i - p_(i-1)),   J_i = dP_i at p_(i-1)
///   F = -dE/dx = g_1 + J_1^T (g_2 + h_1 + J_2^T (g_3 + h_2 + ...)),   h_i = -1/2 S |p_i - p_(i-1)|^2 grad k_i
/// each later pull goes back through the projections before it (Constraint::pull_back). Links that are no projections (friction, forces)
/// hand it on unchanged; torques (alignment.h) are the paper's. k_i is read at the proxy of this tick, for E to be a function of x.
/// Newtons, world axes. Haptic thread: no allocation, lock or throw.
#pragma once
#include "haptics/chain/switching.h"

namespace catena::haptics {

/// The part of the energy that F does not account for: over a closed loop, the work on the hand and this are zero together. It has
///   what the bounds of J leave out, over the hand's motion by the trapezoid rule, and
///   the change of E beside -(F + left_out) dx, in ticks where it is more than the trapezoid rule may miss, |d(F + left_out)| |dx|: a proxy
///   that jumps (to the next straight piece at a concave corner, to another place as near), a link that lets go or is switched, friction
struct UnaccountedEnergy {
  Vec3 force_n{0.0};          ///< -dE/dx of the last tick, without bounds of J
  Vec3 truncated_n{0.0};      ///< the part of it that the bounds left out
  double energy_j = 0;        ///< E of the last tick
  double work_j = 0;          ///< since the start
  bool has_previous = false;  ///< the last tick's values mean something
};

/// F, after the links of this tick have advanced; `gaps` and `shares_n` are p_i - p_(i-1) and g_i by link.
PulledBackForce virtual_work_force(const HapticProgram& program, const LinkOrder& order, const Vec3& probe,
                                   const std::array<Vec3, kMaxLinks>& gaps, const std::array<Vec3, kMaxLinks>& shares_n,
                                   std::array<LinkState, kMaxLinks>& links, std::array<LinkScratch, kMaxLinks>& scratch) noexcept;

/// Books what a tick leaves out; `force` as virtual_work_force returns it, `energy_j` E.
void accumulate_unaccounted(UnaccountedEnergy& state, const PulledBackForce& force, double energy_j, const Vec3& move_m) noexcept;

}  // namespace catena::haptics
