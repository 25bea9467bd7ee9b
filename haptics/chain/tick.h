/// One tick: a pure function of (program, state, probe). The servo thread, `replay`, the tests and the benchmarks run this.
///   chain (section 5):  p_0 = probe;  p_i = advance_i(p_(i-1))
///   force:  F = sum w_i k_i S (p_i - p_(i-1)) - b v,  v = S (x_k - x_(k-1)) / (t_k - t_s_(k-1));  |F| <= max_force
///   or by virtual work (virtual_work.h), where the coupling asks for a conservative force;
///   plus the cues of links that the hand leaves (indication.h), if any. While a step of the links' force is ramped (ramp.h), the sum over
///   the links is cut to max_force by itself, and what the ramp holds back is added
///   torque: of links that align the tool (alignment.h), if any
/// The baselines (baseline.h) keep one proxy p instead: F = K S (p - x) - b v.
/// then the guard (guard.h): what the device's limits and the tick's condition leave of it, and the ledger (passivity.h).
/// Widgets (widgets.h) add their links to the chain, or run alone while one is grabbed, and follow the last proxy.
/// No k_i, and no K of a baseline's force, is above the device's cap (constraint.h).
/// A non-finite probe (or time) holds all proxies, gives zero force and BAD_PROBE. A clock that goes back stands still for a tick.
#pragma once
#include "haptics/chain/alignment.h"
#include "haptics/chain/baseline.h"
#include "haptics/chain/force_limiter.h"
#include "haptics/chain/passivity.h"
#include "haptics/chain/ramp.h"
#include "haptics/chain/release_cue.h"
#include "haptics/chain/switching.h"
#include "haptics/chain/virtual_work.h"
#include "haptics/chain/widgets.h"

namespace catena::haptics {

/// What a tick gets of the hand.
struct ProbeSample {
  double t_s = 0;                                   ///< rises from tick to tick, seconds
  Vec3 position{0.0};                               ///< world units
  std::uint32_t buttons = 0;                        ///< bit n - 1: button n is held
  Quat orientation{kIdentityRotation};              ///< of the tool, world axes
  TickCondition condition = TickCondition::normal;  ///< what the servo knows of this tick
  bool forces_on = true;                            ///< the hand's own switch
};

/// All that the chain remembers from tick to tick: plain data, allocated before the loop. One thread at a time.
struct ChainState {
  std::array<LinkState, kMaxLinks> links{};               ///< by link
  std::array<ReleaseCueState, kMaxLinks> release_cues{};  ///< by link
  SwitchState switches;                                   ///< which links are on
  LinkOrder order;                                        ///< of the last tick
  Ramp ramp;                                              ///< of the force
  UnaccountedEnergy unaccounted;                          ///< of a conservative force
  AlignmentState alignment;                               ///< the rotational chain
  WidgetsState widgets;                                   ///< the widgets
  SingleProxyState single_proxy;                          ///< baselines
  Vec3 last_probe{0.0};                                   ///< of the last tick that had one, world units
  double last_probe_t_s = 0;                              ///< of the last tick with a probe
  double last_tick_t_s = 0;         ///< of the last tick: what a ramp of the guard counts, however long there was no probe
  Vec3 chain_force_n{0.0};          ///< that the chain asks for
  Vec3 requested_force_n{0.0};      ///< of links and their cues, before the hand's damping and any limit (DeviceOutput::requested_force_n)
  ForceLimiterState force_limiter;  ///< what the hand gets
  PassivityState passivity;         ///< the energy account
  std::uint64_t ticks = 0;          ///< so far
  bool has_probe = false;           ///< there was a probe
};
static_assert(std::is_trivially_copyable_v<ChainState>);

/// Caches beside the state that never change a result. Zero at first; one a state.
struct ChainScratch {
  std::array<LinkScratch, kMaxLinks> links{};  ///< by link
};

/// Advances `state` and fills `out` (everything but what the servo writes).
void tick(const HapticProgram& program, const ProbeSample& probe, ChainState& state, ChainScratch& scratch, HapticState& out) noexcept;

/// A new program takes over: links of the same name and the same recipe (or constraint object) keep their state, all others start anew
/// in the next tick. Widgets: widgets.h. Haptic thread: no allocation.
void rebind_program(const HapticProgram& from, const HapticProgram& to, ChainState& state, ChainScratch& scratch) noexcept;

}  // namespace catena::haptics
