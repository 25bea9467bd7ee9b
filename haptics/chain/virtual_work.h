/// The conservative force of a chain (coupling.force), by virtual work. The paper's sum of pulls is not the gradient of any energy: along
/// slow closed loops of the hand it gives or takes up to 0.7 K gap^2 a loop (two planes at 45 degrees). With
///   E = 1/2 sum k_i |S (p_i - p_(i-1))|^2,   p_i = P_i(p_(i-1)),   g_i = w_i k_i S (p_i - p_(i-1)),   J_i = dP_i at p_(i-1)
///   F = -dE/dx = g_1 + J_1^T (g_2 + h_1 + J_2^T (g_3 + h_2 + ...)),   h_i = -1/2 S |p_i - p_(i-1)|^2 grad k_i
/// each later pull goes back through the projections before it (Constraint::pull_back). Links that are no projections (friction, forces)
/// hand it on unchanged; torques (alignment.h) are the paper's. k_i is read at the proxy of this tick, for E to be a function of x.
/// Newtons, world axes. Haptic thread: no allocation, lock or throw.
#pragma once
#include "haptics/chain/switching.h"

namespace catena::haptics {

/// The work that the bounds of J leave out: what is returned as `left_out`, over the hand's motion by the trapezoid rule.
struct LeftOut {
  Vec3 force_n{0.0};  ///< of the last tick
  double work_j = 0;  ///< since the start
};

/// F, after the links of this tick have advanced; `gaps` and `shares_n` are p_i - p_(i-1) and g_i by link.
PulledBack virtual_work(const Program& program, const Order& order, const Vec3& probe, const std::array<Vec3, kMaxLinks>& gaps,
                        const std::array<Vec3, kMaxLinks>& shares_n, std::array<LinkState, kMaxLinks>& links,
                        std::array<LinkScratch, kMaxLinks>& scratch) noexcept;

/// Books what a tick leaves out.
inline void book(LeftOut& state, const Vec3& left_out_n, const Vec3& move_m) noexcept {
  state.work_j += 0.5 * dot(state.force_n + left_out_n, move_m);
  state.force_n = left_out_n;
}

}  // namespace catena::haptics
