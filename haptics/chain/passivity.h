// SPDX-License-Identifier: MIT
/// Energy account of the links, passivity observer over all of them, and passivity controller. World axes; energies in joules, with
/// displacements in meters of probe travel (device scale applied: x S).
///   work      W_i = S f_i(k-1) . (x_k - x_(k-1)): the force of a tick is held until the next tick, so the sum is exact and needs no
///             estimate of a velocity (sampled form of Hannaford & Ryu, "Time-domain passivity control of haptic interfaces", IEEE Trans.
///             Robotics and Automation 18(1), 2002). f_i is the link's share of the force as it was sent. With a conservative force f_i
///             acts at the link's own probe, so that x is p_(i-1) there
///   storage   with a conservative force V_i = S/2 f_i . (p_i - p_(i-1)), which is K/2 |S gap|^2; else V_i = S/2 f_i . (p_n - x), with p_n
///             the chain's last proxy: the sum is K/2 |S (p_n - x)|^2 where all links are equally stiff, and K/2 |S gap|^2 for one link;
///             less where the force is limited
///   account   accounted_i = sum of W_i + V_i: the energy that the link has given to the user and has stored, minus what it received. A
///             probe at rest changes it by 1/2 K (|x - p_new|^2 - |x - p_old|^2), which is round-off. It rises by the energy that a
///             switch, a mode, a snap, a re-engagement or another program puts into the spring, and by the energy that is generated because
///             the force is held between ticks: K/2 |dx|^2 per tick
///   observer  B_k = B_(k-1) - (W + V_k - V_(k-1)) + b |dx|^2 / dt + exempt, at most 0;  E = V + B: energy that the user may still get
///             back. b: the device's own damping, so that B stays 0 below K = 2 b / T (Colgate & Schenkel, "Passivity of a class of
///             sampled-data systems", J. Robotic Systems 14(1), 1997). A surplus is not kept: it would pay for the energy that an unstable
///             contact gives out later
///   exempt    energy that the program gives to the user and that the controller must not take back: jumps of V at switches, snaps and
///             programs; rising weights and ramp factors; the ramped force (ramp.h) up to the energy of the springs that engaged or
///             released; cues; and links that are energy sources by design (Constraint::is_energy_source: gradient_force), which have no
///             storage
///   controller  damping of the probe. Where B plus its last step is below 0 the damping is large enough to take that energy out within the
///             next tick if the probe keeps its velocity, but at most max_added_damping. It then shrinks by the factor 1 - dt / 30 ms per
///             tick, so that it is not perceived as a buzz. No bound is claimed against something that reverses its motion in every tick
///             with more force than a person can apply: no damping helps there
/// Delay of the device: the observer's work is that of the forces that have acted since the last tick; a link's own account uses its last
/// share. While there is no probe (a lost device) nothing is accounted; links engage from a fresh state afterwards. Torques are not
/// counted. The account is always kept; the controller acts only where limits.passivity_control is set. Haptic thread: no allocation, lock
/// or throw.
#pragma once
#include "engine/base/export.h"
#include "haptics/chain/force_limiter.h"
#include "haptics/chain/switching.h"

namespace catena::haptics {

/// Energy account between ticks. Joules and newtons, world axes.
struct PassivityState {
  /// Force that was sent in one tick.
  struct SentForce {
    Vec3 force_n{0.0};    ///< whole force
    Vec3 exempt_n{0.0};   ///< part that is exempt
    Vec3 ramped_n{0.0};   ///< part that is the ramp offset e (ramp.h)
    Vec3 damping_n{0.0};  ///< part added by the controller
  };
  static constexpr std::uint32_t kHistoryLength = 16;  ///< length of `history`; a delay of more than 14 periods counts as 14

  std::array<double, kMaxLinks> work_j{};           ///< sum of W_i
  std::array<double, kMaxLinks> stored_j{};         ///< V_i
  std::array<Vec3, kMaxLinks> sent_shares_n{};      ///< f_i of the last tick
  std::array<Vec3, kMaxLinks> probes{};             ///< p_(i-1) of the last tick, world units
  std::array<double, kMaxLinks> weights{};          ///< w_i of the last tick
  std::array<bool, kMaxLinks> detached{};           ///< the link does not constrain the probe: off, released, or no feature there
  LinkOrder order;                                  ///< link order of the last tick
  std::array<SentForce, kHistoryLength> history{};  ///< sent forces of the last ticks, a ring
  std::uint32_t next_index = 0;                     ///< index in `history` of the next entry
  double ramp_factor = 0;                           ///< fraction of the chain force that the limiter passed in the last tick, 0..1
  double storage_j = 0;                             ///< V
  double balance_j = 0;                             ///< B
  double exempt_j = 0;                              ///< exempt energy since the start
  double released_j = 0;                            ///< energy of springs that engaged or released, which the ramped force may still give
  double dissipated_j = 0;                          ///< energy dissipated by the controller since the start
  double damping_ns_per_m = 0;                      ///< present damping of the controller
  bool rebase_pending = true;                       ///< the next storage is not due to the user: start, another program, a lost device

  /// Returns the energy account of a link, joules.
  double accounted_j(std::size_t link) const noexcept { return work_j[link] + stored_j[link]; }
  /// Returns E, the energy that the user may still get back, joules.
  double energy_j() const noexcept { return storage_j + balance_j; }
};

/// Input of the energy account in one tick.
struct EnergyTick {
  Vec3 displacement{0.0};                       ///< x_k - x_(k-1), world units
  const std::array<Vec3, kMaxLinks>& probes;    ///< p_(i-1), world units
  const std::array<Vec3, kMaxLinks>& gaps;      ///< p_i - p_(i-1), world units
  Vec3 chain_gap{0.0};                          ///< p_n - x, world units
  double dt_s = 0;                              ///< time since the last tick with a probe, seconds
  const LinkOrder& order;                       ///< links that run
  const std::array<Vec3, kMaxLinks>& shares_n;  ///< f_i before any limit
  Vec3 cues_n{0.0}, ramped_n{0.0};              ///< sum of the release cues; ramp offset e
  Vec3 total_force_n{0.0};                      ///< links, ramp offset, cues and the coupling's damping, before any limit
};

/// Steps the energy account of one tick, after the force limiter; adds the controller's damping force to guard.force_n. `links` and `guard`
/// are those of this tick.
CATENA_EXPORT void step_passivity(const HapticProgram& program, const std::array<LinkState, kMaxLinks>& links, const EnergyTick& tick,
                                  ForceLimiterState& guard, PassivityState& state) noexcept;

/// Marks a tick without a probe: no force is sent, and the work since the last tick is unknown.
CATENA_EXPORT void pause_passivity(PassivityState& state) noexcept;

}  // namespace catena::haptics
