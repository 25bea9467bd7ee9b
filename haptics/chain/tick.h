// SPDX-License-Identifier: MIT
/// One haptic tick: a pure function of (program, state, probe), run by the servo thread, `replay`, the tests and the benchmarks.
///   chain (section 5):  p_0 = probe;  p_i = advance_i(p_(i-1))
///   force:  F = sum w_i k_i S (p_i - p_(i-1)) - b v,  v = S (x_k - x_(k-1)) / (t_k - t_(k-1));  |F| <= max_force
///   With CouplingForce::conservative the sum is replaced by the force by virtual work (virtual_work.h).
///   The release cues of the links (release_cue.h) are added. While a step of the links' force is ramped (ramp.h), the sum over the links
///   is limited to max_force by itself, and the ramp offset is added.
///   torque: that of the links that align the tool (alignment.h)
/// The baselines (baseline.h) keep one proxy p instead: F = K S (p - x) - b v.
/// The force limiter (force_limiter.h) then applies the device's limits and the tick's condition, and the energy account (passivity.h)
/// follows. Widgets (widgets.h) add their links to the chain, or run alone while one is grabbed, and follow the last proxy.
/// Every k_i, and the K of a baseline's force, is capped by the device's limit (constraint.h).
/// A probe or time that is not finite, and a tick without device or stopped by the watchdog, hold all proxies and give zero force and
/// BAD_PROBE. A clock that goes backward counts as dt = 0.
#pragma once
#include "engine/base/export.h"
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

/// Input of one tick.
struct ProbeSample {
  double t_s = 0;                                   ///< time, increases from tick to tick, seconds
  Vec3 position{0.0};                               ///< position of the probe, world units
  std::uint32_t buttons = 0;                        ///< bit n - 1: button n is down
  Quat orientation{kIdentityRotation};              ///< rotation from tool axes to world axes
  TickCondition condition = TickCondition::normal;  ///< condition of the tick, set by the servo
  bool forces_on = true;                            ///< the user's force switch and the device's own switch are both on
  /// Bricks of the program's paged grids that are in memory; null: none, the coarse levels are felt. That of the last tick must be alive.
  const field::BrickSnapshot* bricks = nullptr;
};

/// Complete state of the chain between ticks: plain data, allocated before the loop. Used by one thread at a time.
struct ChainState {
  std::array<LinkState, kMaxLinks> links{};               ///< state of each link
  std::array<ReleaseCueState, kMaxLinks> release_cues{};  ///< state of each link's release cue
  SwitchState switches;                                   ///< switches of links and modes
  LinkOrder order;                                        ///< link order of the last tick
  Ramp ramp;                                              ///< ramp of the force
  std::int32_t limited_ticks = 0;                         ///< ticks in which steps of the force are limited (bricks.h)
  UnaccountedEnergy unaccounted;                          ///< energy that a conservative force does not account for
  AlignmentState alignment;                               ///< rotational chain
  WidgetsState widgets;                                   ///< widgets
  SingleProxyState single_proxy;                          ///< single proxy of the baselines
  Vec3 last_probe{0.0};                                   ///< probe of the last tick that had one, world units
  double last_probe_t_s = 0;                              ///< time of the last tick with a probe, seconds
  double last_tick_t_s = 0;                               ///< time of the last tick, with or without a probe, seconds; ramps count from it
  Vec3 chain_force_n{0.0};                                ///< chain force, before the force limiter
  Vec3 requested_force_n{0.0};      ///< links, ramp offset and cues, before damping and any limit (DeviceOutput::requested_force_n)
  ForceLimiterState force_limiter;  ///< force limiter, with the commanded force
  PassivityState passivity;         ///< energy account
  std::uint64_t ticks = 0;          ///< number of ticks so far
  bool has_probe = false;           ///< at least one tick had a probe
};
static_assert(std::is_trivially_copyable_v<ChainState>);

/// Caches that never change a result, and the bricks of the last tick. Zero at first; one per ChainState.
struct ChainScratch {
  std::array<LinkScratch, kMaxLinks> links{};    ///< caches of each link
  const field::BrickSnapshot* bricks = nullptr;  ///< ProbeSample::bricks of the last tick
};

/// Runs one tick: advances `state` and sets all of `out` but what the servo writes. Haptic thread: no allocation, lock, throw.
CATENA_EXPORT void tick(const HapticProgram& program, const ProbeSample& probe, ChainState& state, ChainScratch& scratch,
                        HapticState& out) noexcept;

/// Adapts the state to a new program: links of the same name and spec_hash (or the same constraint object) keep their state, all others are
/// re-initialized in the next tick. Widgets: widgets.h. Haptic thread: no allocation.
CATENA_EXPORT void rebind_program(const HapticProgram& from, const HapticProgram& to, ChainState& state, ChainScratch& scratch) noexcept;

}  // namespace catena::haptics
