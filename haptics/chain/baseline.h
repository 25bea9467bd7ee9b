// SPDX-License-Identifier: MIT
/// Baselines with which the paper compares the chain (section 3): one proxy p for all links, F = K S (p - x) - b v.
///   pipe     [6]   the constraints are applied in turn, p = advance_i(p), until all are satisfied; baseline_subspace.cpp
///   balance  [13]  p balances the springs to the probe and to the links' linear primitives; baseline.cpp
///   closest  [9]   p is the nearest of the constraints' own projections of the probe; baseline_subspace.cpp
///   linear   [7]   p moves with the probe as far as the linear primitives at p leave it free, never corrected; baseline_subspace.cpp
/// Release: an engaged link releases in the tick in which |x - p| >= its release, and p is recomputed without it. It re-engages by the
/// probe x: a one-sided link where x is on the free side, a two-sided one where x crosses the surface or comes within a tenth of release.
/// Where no link is engaged p = x, bit for bit.
/// Every link reports p. An engaged link reports an equal share of F (weight 1 / number of engaged links, stiffness K), the others none.
/// Weights do not rise at a switch: the step of the whole force is ramped (ramp.h).
/// LinkState::proxy remains the constraint's own proxy. Haptic thread: no allocation, lock, throw or unbounded loop.
#pragma once
#include "engine/base/export.h"
#include "haptics/chain/switching.h"

namespace catena::haptics {

/// State of the baselines between ticks.
struct SingleProxyState {
  /// Release state of one link.
  struct ReleaseState {
    double height = 0;         ///< signed height of the probe above a surface that is released, world units
    bool has_height = false;   ///< `height` is valid
    bool released = false;     ///< the link is released
    bool was_holding = false;  ///< the link was engaged in the last tick
  };
  Vec3 proxy{0.0};                                       ///< p, world units
  Vec3 probe{0.0};                                       ///< probe of the last tick, world units
  bool has_proxy = false;                                ///< `proxy` is valid
  bool settled = false;                                  ///< converged: an unchanged probe and link order give the same result
  std::array<ReleaseState, kMaxLinks> release_states{};  ///< release state of each link
};

/// Input and output of one tick of a method, which computes p and sets `holding` and each link's status and residual.
struct CATENA_EXPORT SingleProxyTick {
  const HapticProgram& program;                 ///< program that runs
  const LinkOrder& order;                       ///< links that run
  Vec3 probe;                                   ///< position of the probe, world units
  double dt_s;                                  ///< time since the last tick with a probe, seconds
  bool first_tick;                              ///< no earlier tick had a probe
  SingleProxyState& state;                      ///< p and the release states
  std::array<LinkState, kMaxLinks>& links;      ///< state of each link
  std::array<LinkScratch, kMaxLinks>& scratch;  ///< caches of each link
  double domain_length = 0;                     ///< L, the largest of the links' domain lengths, world units
  int iterations = 0;                           ///< iterations of the pipe in this tick
  std::array<bool, kMaxLinks> holding{};        ///< the link is engaged in this tick

  /// Calls f(i) for the links that run and are not released, in order.
  template <class F>
  void for_each_held_link(const F& f) noexcept {
    for (int k = 0; k < order.count; ++k) {
      const auto i = static_cast<std::size_t>(order.links[static_cast<std::size_t>(k)]);
      if (!state.release_states[i].released) f(i);
    }
  }
  /// Runs the constraint's own `advance`. Returns whether the constraint holds the probe.
  bool apply(std::size_t i, const Vec3& incoming) noexcept;
  /// Computes the constraint's primitive near `at`, world units. Returns false if there is none; the link's status is the cause.
  bool primitive(std::size_t i, const Vec3& at, Primitive& out) noexcept;
};

/// Moves state.proxy according to the probe. `same_order`: the link order is that of the last tick.
CATENA_EXPORT void advance_single_proxy(SingleProxyTick& tick, bool same_order) noexcept;

/// Returns p by the method pipe: the point at which the iteration converges, or ends after its maximum of passes.
CATENA_EXPORT Vec3 solve_pipe(SingleProxyTick& tick) noexcept;
/// Returns p by the method balance.
CATENA_EXPORT Vec3 solve_balance(SingleProxyTick& tick) noexcept;
/// Returns p by the method closest.
CATENA_EXPORT Vec3 solve_closest(SingleProxyTick& tick) noexcept;
/// Returns p by the method linear.
CATENA_EXPORT Vec3 solve_linear(SingleProxyTick& tick) noexcept;

/// Linear equations of several primitives (at most three independent ones): the directions that they constrain, and the shortest step that
/// satisfies all of them.
class CATENA_EXPORT ConstrainedSubspace {
 public:
  /// Adds the equations of a primitive relative to the point `from`; equations that depend on earlier ones, or contradict them, are
  /// dropped.
  void add(const Primitive& primitive, const Vec3& from) noexcept;
  /// Returns the shortest step from `from` that satisfies all equations.
  Vec3 shortest_step() const noexcept;
  /// Returns the component of v along the directions that are not constrained.
  Vec3 project_free(Vec3 v) const noexcept;

 private:
  void add(const Vec3& normal, double distance) noexcept;
  std::array<Vec3, 3> rows_{};
  std::array<double, 3> distances_{};
  int count_ = 0;
};

/// Returns the distance of a point from a primitive, world units.
CATENA_EXPORT double distance_to(const Primitive& primitive, const Vec3& point) noexcept;

}  // namespace catena::haptics
