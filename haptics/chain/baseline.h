/// The baselines that the paper compares the chain with (section 3): one proxy p for all links, F = K S (p - x) - b v.
///   pipe     [6]   the constraints are applied again and again, p = advance_i(p), until all are satisfied; baseline_spans.cpp
///   balance  [13]  p balances the springs to the probe and to the links' linear primitives; baseline.cpp
///   closest  [9]   of the constraints' own projections of the probe, the nearest; baseline_spans.cpp
///   linear   [7]   the probe's move along what the linear primitives at p leave free, never corrected; baseline_spans.cpp
/// Release: a link that holds lets go in the tick in which |x - p| >= its release, and p is found again without it. It takes hold
/// again by the probe x itself: one-sided links on the free side, two-sided ones where x crosses the surface or comes within a
/// tenth of release. Where no link holds p = x, bit for bit.
/// Every link reports p. A link that holds reports an equal share of F (weight 1 / their number, stiffness K), the others none;
/// no weights rise at a switch: the step of the whole force is ramped (ramp.h).
/// In LinkState `proxy` stays the constraint's own. Haptic thread: no allocation, lock, throw or unbounded loop.
#pragma once
#include "haptics/chain/switching.h"

namespace catena::haptics {

/// What the baselines remember.
struct SingleProxyState {
  /// What is remembered of a link.
  struct ReleaseState {
    double height = 0;         ///< of the probe above a surface that has let go
    bool has_height = false;   ///< `height` means something
    bool released = false;     ///< it has let go
    bool was_holding = false;  ///< in the last tick
  };
  Vec3 proxy{0.0};                                       ///< p, world units
  Vec3 probe{0.0};                                       ///< of the last tick
  bool has_proxy = false;                                ///< `proxy` means something
  bool settled = false;                                  ///< a probe that rests gives the same again
  std::array<ReleaseState, kMaxLinks> release_states{};  ///< by link
};

/// One tick as the methods see it; they find p and set `holds`, and each link's status and residual.
struct SingleProxyTick {
  const HapticProgram& program;                 ///< what runs
  const LinkOrder& order;                       ///< which links run
  Vec3 probe;                                   ///< the hand, world units
  double dt_s;                                  ///< since the last tick
  bool first_tick;                              ///< there was no tick before
  SingleProxyState& state;                      ///< p, and what else is remembered
  std::array<LinkState, kMaxLinks>& links;      ///< by link
  std::array<LinkScratch, kMaxLinks>& scratch;  ///< by link
  double domain_length = 0;                     ///< L, the largest of the links
  int iterations = 0;                           ///< of the pipe, in this tick
  std::array<bool, kMaxLinks> holding{};        ///< by link: it holds in this tick

  /// Calls f(i) for the links that run and have not let go, in order.
  template <class F>
  void for_each_held_link(const F& f) noexcept {
    for (int k = 0; k < order.count; ++k) {
      const auto i = static_cast<std::size_t>(order.links[static_cast<std::size_t>(k)]);
      if (!state.release_states[i].released) f(i);
    }
  }
  /// The constraint's own advance. True where it holds.
  bool apply(std::size_t i, const Vec3& incoming) noexcept;
  /// The constraint's primitive near `at`; none: false, and the status says why.
  bool primitive(std::size_t i, const Vec3& at, Primitive& out) noexcept;
};

/// Moves state.proxy by the probe; `same_order`: the order of the last tick.
void advance_single_proxy(SingleProxyTick& tick, bool same_order) noexcept;

/// By "pipe": where p comes to rest.
Vec3 solve_pipe(SingleProxyTick& tick) noexcept;
/// By "balance".
Vec3 solve_balance(SingleProxyTick& tick) noexcept;
/// By "closest".
Vec3 solve_closest(SingleProxyTick& tick) noexcept;
/// By "linear".
Vec3 solve_linear(SingleProxyTick& tick) noexcept;

/// The directions that some primitives take away, and the shortest way onto all of them.
class ConstrainedSubspace {
 public:
  /// Adds a primitive's equations, as seen from `from`; what contradicts those before it is left out.
  void add(const Primitive& primitive, const Vec3& from) noexcept;
  /// The shortest move from `from` that satisfies all.
  Vec3 shortest_step() const noexcept;
  /// A vector without what is taken away.
  Vec3 project_free(Vec3 v) const noexcept;

 private:
  void add(const Vec3& normal, double distance) noexcept;
  std::array<Vec3, 3> rows_{};
  std::array<double, 3> distances_{};
  int count_ = 0;
};

/// The distance of a place from a primitive.
double distance_to(const Primitive& primitive, const Vec3& place) noexcept;

}  // namespace catena::haptics
