/// The energy ledger of the links, the passivity observer over all of them, and the controller. World axes, joules of hand.
///   work      W_i = S f_i(k-1) . (x_k - x_(k-1)): the force of a tick is held until the next one, so the sum is exact and
///             needs no guess at a velocity (the sampled form of Hannaford & Ryu, "Time-domain passivity control of haptic
///             interfaces", IEEE Trans. Robotics and Automation 18(1), 2002). f_i is the link's share as it was sent; of a conservative
///             force it pulls at the link's own probe, so that x is p_(i-1) there
///   storage   of a conservative force V_i = S/2 f_i . (p_i - p_(i-1)), which is K/2 |S gap|^2; else V_i = S/2 f_i . (p_n - x), with p_n
///   the chain's last proxy: their sum is K/2 |S (p_n - x)|^2 where all links
///             are equally stiff, and K/2 |S gap|^2 for one link; less where the force is limited
///   ledger    booked_i = sum of W_i + V_i: what the link has given to the hand and has ready for it, beyond what it got. A
///             still probe changes it by 1/2 K (|x - p_new|^2 - |x - p_old|^2), which is round-off. It rises by what a switch, a
///             mode, a snap, a hold taken anew or another program puts into the spring, and by what holding the force
///             between ticks makes up: K/2 |dx|^2 a tick.
///   observer  B_k = B_(k-1) - (W + V_k - V_(k-1)) + b |dx|^2 / dt + granted, at most 0;  E = V + B, what the hand may still get
///             back. b: the device's own damping, so that B stays 0 below K = 2 b / T (Colgate & Schenkel, "Passivity of a
///             class of sampled-data systems", J. Robotic Systems 14(1), 1997). A surplus is not kept: it would pay for what
///             an unstable contact gives out later.
///   granted   to the hand by the program, not to be taken back by the controller: the jumps of V at switches, snaps and
///             programs, weights and ramps that rise, what is ramped (ramp.h) as far as the springs that came or went have it, cues, and
///             links that are sources of energy by what they are (Constraint::is_energy_source: gradient_force), which have no storage
///   controller  a damping of the hand. Where B and its last step together are below 0 it is large enough to take that energy out within
///             the next tick if the hand keeps its velocity, but at most max_added_damping. Then it shrinks by the factor 1 - dt / 30 ms
///             in each tick, so that it is not felt as a buzz. Against something that reverses in every tick with more force than a
///             person's hand has, no damping helps: no bound is claimed there
/// A device's delay: the observer's work is that of the forces that acted since the last tick; a link's own ledger is that of its
/// last share. Against a probe that is not there for a while (a lost device) nothing is booked; links are then taken hold of anew. Torques
/// are not counted. Always booked; controlled only where limits.passivity is set. Haptic thread: no allocation, lock or throw.
#pragma once
#include "haptics/chain/force_limiter.h"
#include "haptics/chain/switching.h"

namespace catena::haptics {

/// The ledger. Joules and newtons, world axes.
struct PassivityState {
  /// What was sent in a tick.
  struct SentForce {
    Vec3 force_n{0.0};    ///< all of it
    Vec3 exempt_n{0.0};   ///< its part that is granted
    Vec3 ramped_n{0.0};   ///< its part that is ramped
    Vec3 damping_n{0.0};  ///< the controller's
  };
  static constexpr std::uint32_t kHistoryLength = 16;  ///< a delay of more than 14 periods counts as 14

  std::array<double, kMaxLinks> work_j{};           ///< sum of W_i
  std::array<double, kMaxLinks> stored_j{};         ///< V_i
  std::array<Vec3, kMaxLinks> sent_shares_n{};      ///< f_i, of the last tick
  std::array<Vec3, kMaxLinks> probes{};             ///< p_(i-1), of the last tick, world units
  std::array<double, kMaxLinks> weights{};          ///< w_i of the last tick
  std::array<bool, kMaxLinks> detached{};           ///< not held: off, let go, or nothing there
  LinkOrder order;                                  ///< of the last tick
  std::array<SentForce, kHistoryLength> history{};  ///< by tick
  std::uint32_t next_index = 0;                     ///< where the next one goes in `past`
  double ramp_factor = 0;                           ///< the part of the chain's force that the guard let through in the last tick, 0 to 1
  double storage_j = 0;                             ///< V
  double balance_j = 0;                             ///< B
  double exempt_j = 0;                              ///< since the start
  double released_j = 0;                            ///< of springs that came or went in one tick: what the ramp may still give
  double dissipated_j = 0;                          ///< by the controller, since the start
  double damping_ns_per_m = 0;                      ///< that the controller adds now
  bool rebase_pending = true;  ///< whatever the storage is now, nothing the hand did made it so: start, another program, a lost device

  /// The account of a link.
  double accounted_j(std::size_t link) const noexcept { return work_j[link] + stored_j[link]; }
  /// E: what the hand may still get back.
  double energy_j() const noexcept { return storage_j + balance_j; }
};

/// One tick as the ledger sees it, before and after the guard.
struct EnergyTick {
  Vec3 displacement{0.0};                       ///< x_k - x_(k-1), world units
  const std::array<Vec3, kMaxLinks>& probes;    ///< p_(i-1), world units
  const std::array<Vec3, kMaxLinks>& gaps;      ///< p_i - p_(i-1), world units
  Vec3 chain_gap{0.0};                          ///< p_n - x, world units
  double dt_s = 0;                              ///< since the last tick
  const LinkOrder& order;                       ///< the links that run
  const std::array<Vec3, kMaxLinks>& shares_n;  ///< f_i as the chain asks for them
  Vec3 cues_n{0.0}, ramped_n{0.0};              ///< cues; what is ramped
  Vec3 total_force_n{0.0};                      ///< shares, others and damping, before any limit
};

/// Books the tick; adds the controller's force to guard.force_n. `guard` is this tick's, `links` are.
void step_passivity(const HapticProgram& program, const std::array<LinkState, kMaxLinks>& links, const EnergyTick& tick,
                    ForceLimiterState& guard, PassivityState& state) noexcept;

/// A tick without a probe: no force is sent, and what it did until now is not known.
void pause_passivity(PassivityState& state) noexcept;

}  // namespace catena::haptics
