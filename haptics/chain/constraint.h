/// The interface of every constraint, what a link remembers from tick to tick, and what a device allows.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <limits>
#include <new>
#include <type_traits>

#include "engine/base/haptic_state.h"
#include "engine/base/result.h"
#include "engine/field/field.h"
#include "engine/widget/widget.h"
#include "haptics/chain/state_hash.h"

namespace catena::haptics {

/// What a device, not a scene, allows; infinity: no limit. All off by default: `replay` without a device has none. Metres of hand, newtons.
struct DeviceLimits {
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();  ///< no limit

  double max_stiffness_n_per_m = kUnlimited;                ///< cap of every k_i
  double max_rotational_stiffness_nm_per_rad = kUnlimited;  ///< cap of the rotational coupling
  double max_force_n = kUnlimited;                          ///< |F|, direction kept
  double max_torque_nm = kUnlimited;                        ///< |torque|, direction kept
  double slew_n_per_s = kUnlimited;                         ///< |dF/dt|; never delays a force's way to zero on a fault
  double ramp_in_s = 0;                                     ///< 0..1 from the moment the force is switched on
  double ramp_out_s = 0.02;                                 ///< to zero, after too many late ticks
  int max_late_ticks = 5;                                   ///< so many late ticks in a row hold the last force; more ramp out
  bool passivity_control = false;                           ///< observer and controller
  double damping_ns_per_m = 0;                              ///< the device's own, on which the observer may count
  double delay_s = 0;                                       ///< from the pose to the force: the observer counts the force that acted
  double max_added_damping_ns_per_m = kUnlimited;           ///< most that the passivity controller may add; more shakes a light device
};

inline constexpr int kMaxEvaluations = 257;  ///< field fetches a link and tick, for every method
/// All that takes time in a link's tick goes into one counter, in units of about 20 ns: a field fetch counts kFetchWork (of a cell that
/// may lie anywhere in a grid, kCellWork more, of a cubic one kCubicWork), and every evaluation of a cell's polynomial, node of a search,
/// knot or face that is visited 1. A constraint stops before kMaxWork, with BUDGET, and goes on in the next tick.
inline constexpr int kMaxWork = 4096, kFetchWork = 7, kCellWork = 8, kCubicWork = 16;  ///< units of work of a link and tick
inline constexpr int kReservedWork = 256;  ///< of the cap: for what is begun before it is used up
/// Of max_force: what a proxy's slip may add to the force in one tick, so that with its probe's motion it stays below 5 %.
inline constexpr double kSlipFraction = 0.04;
inline constexpr double kRearmFraction = 0.1;  ///< of `release`: within it a link that has let go takes hold again
inline constexpr double kMaxProbeSpeed = 15;   ///< m/s: a probe that moves faster was thrown

/// What "bit for bit" means: tells -0 from 0, and a NaN is itself.
inline bool bitwise_equal(const Vec3& a, const Vec3& b) noexcept { return std::memcmp(&a, &b, sizeof a) == 0; }

/// What a link remembers from tick to tick: plain data, copied bit for bit into recordings. Only the haptic thread changes it.
struct LinkState {
  Vec3 proxy{0.0};                                   ///< where the constraint holds the probe, world units
  double residual = 0;                               ///< distance from the constraint, world units
  double limit = 0;                                  ///< |probe - proxy| at which the link slips or lets go now, world units; 0: never
  double dt_s = 0;                                   ///< since the last tick; 0 in the first
  double stiffness_n_per_m = 0;                      ///< k_i of this tick
  double max_probe_step = 0;                         ///< the longest way of a hand in this tick, kMaxProbeSpeed dt / S, world units
  std::int32_t evaluations = 0;                      ///< field fetches of this tick
  std::int32_t other_work = 0;                       ///< other counted work of this tick
  std::int32_t max_work = kMaxWork - kReservedWork;  ///< of this tick's work; a constraint may ask for less
  /// How far the proxy may slip in this tick beyond what its probe moves, world units: kSlipFraction max_force / (k_i S).
  double max_slip = std::numeric_limits<double>::infinity();
  std::int32_t curve_index = -1;                     ///< the line of a file that it holds to; -1: none
  LinkStatus status = LinkStatus::ok;                ///< how the link is
  SampleStatus reason = SampleStatus::ok;            ///< set together with a status of critical or boundary; means nothing beside another
  bool started = false;                              ///< `start` has been called
  bool released = false;                             ///< let go; re-arms by the constraint's own rule
  bool switched_on = false;                          ///< its switch
  double weight = 1;                                 ///< w_i
  widget::LinkShape shape{};                         ///< a widget's link: what it is on in this tick (widgets.h)
  alignas(16) std::array<std::byte, 1024> memory{};  ///< the constraint's own, zero at start; see memory_as
  alignas(16) std::array<std::byte, 128> wrapper_memory{};  ///< of a constraint that wraps another one, zero at start

  /// How far the proxy may move in a tick in which its probe moves by `moved` and is `gap` away. A gap that is more than max_force allows
  /// gives max_force all the same: there a part of the gap turns it as little as the slip would.
  double max_travel(double moved, double gap) const { return moved + std::max(max_slip, kSlipFraction * gap); }
  /// Whether it is switched on and has not let go.
  bool active() const { return switched_on && !released; }
  /// Units of work of this tick so far.
  int work() const { return kFetchWork * evaluations + other_work; }
  /// Of `wanted` steps, how many may still be made.
  int affordable_steps(int wanted) const { return std::max(0, std::min(wanted, max_work - work())); }
  /// Less than `reserve` units are left.
  bool exhausted(int reserve = 0) const { return work() + reserve >= max_work; }
  /// Sets counters and what is told back, before a tick.
  void begin_tick() {
    evaluations = other_work = 0;
    max_work = kMaxWork - kReservedWork;
    curve_index = -1;
  }
};
static_assert(std::is_trivially_copyable_v<LinkState>);

/// LinkStatus and reason at once, where the field ends a motion.
inline void set_link_status(LinkState& state, LinkStatus status, SampleStatus reason) noexcept {
  state.status = status;
  state.reason = reason;
}

/// The constraint's private memory in the state, as its own plain struct T (zero bytes must be a legal T).
template <class T>
T& memory_as(LinkState& state) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= sizeof(state.memory) && alignof(T) <= 16);
  return *std::launder(reinterpret_cast<T*>(state.memory.data()));
}

/// The same for a constraint that wraps another one, which keeps `memory`.
template <class T>
T& wrapper_memory_as(LinkState& state) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= sizeof(state.wrapper_memory) && alignof(T) <= 16);
  return *std::launder(reinterpret_cast<T*>(state.wrapper_memory.data()));
}

/// The same, to read.
template <class T>
const T& memory_as(const LinkState& state) {
  return memory_as<T>(const_cast<LinkState&>(state));
}
/// The same, to read.
template <class T>
const T& wrapper_memory_as(const LinkState& state) {
  return wrapper_memory_as<T>(const_cast<LinkState&>(state));
}

/// Caches of a link that never change a result. Haptic thread.
struct LinkScratch {
  std::array<field::Cursor, 4> cursors{};                ///< the constraint's
  field::Cursor parameter_cursor{}, stiffness_cursor{};  ///< of its parameters, of the link's stiffness
};

/// A constraint near a place, as the baselines of the paper's section 3 see it: a haptic primitive.
///   point: p = origin;   line: p = origin + s axis;   plane: axis . (p - origin) = 0
struct Primitive {
  /// What it leaves free: nothing, a line, a plane.
  enum class Kind { point, line, plane };
  Kind kind = Kind::point;  ///< which equation holds
  Vec3 origin{0.0};         ///< a place on it, world units
  Vec3 axis{0.0};           ///< unit: the line's direction, the plane's normal
};

/// A force on the probe, and what the bound of a derivative takes from it (rules/pull_back.h).
struct PulledBackForce {
  Vec3 force{0.0};      ///< J^T f, J bounded
  Vec3 truncated{0.0};  ///< the unbounded J^T f less that; zero where nothing was bounded
};

/// The interface of every constraint (paper, section 3): a rule that keeps a proxy. Derive from it, describe it by a ConstraintType
/// (haptics/constraints/registry.h), and scenes can name it. A Constraint object is the immutable specification, made off the tick; what
/// changes from tick to tick is in LinkState (plain data), and caches that never change a result are in LinkScratch.
/// `start` and `advance` run on the haptic thread: no allocation, lock, throw, or unbounded loop; same bits for same input.
class Constraint {
 public:
  virtual ~Constraint() = default;
  Constraint() = default;
  Constraint(const Constraint&) = delete;
  Constraint& operator=(const Constraint&) = delete;

  /// Before the link's first tick: places the proxy (seed, or projection of the first incoming probe); may set `released`.
  /// The evaluations that it spends count into the first tick's `state.evaluations` (which `advance` then adds to).
  virtual void start(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept = 0;

  /// One tick: moves state.proxy by the (finite) incoming probe; sets status, residual, released and adds to evaluations.
  /// Where the constraint does not hold (released, free side, no surface) the proxy equals the probe bit for bit.
  virtual void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept = 0;

  /// The linear primitive that stands for the constraint near `at`; its fetches count. False: it has none (friction, forces), or
  /// none here. `state` is the link's own, as advance left it.
  virtual bool primitive(const Vec3& at, LinkState& state, LinkScratch& scratch, Primitive& out) const noexcept {
    (void)at, (void)state, (void)scratch, (void)out;
    return false;
  }
  /// True where `primitive` is implemented: what the baselines can combine.
  virtual bool has_primitive() const noexcept { return false; }

  /// Places the proxy at the closest feature, wherever it was, while a link that snaps waits to take hold: called every tick
  /// instead of advance, and before the first start (`memory` is zero then). A constraint with many local minima may take
  /// several ticks over the search.
  virtual void seek(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept { start(probe, state, scratch); }

  /// What the force f on the proxy is for the probe, by virtual work: J^T f with J = dp/dx, at the state that `advance` left. Its fetches
  /// count. By default f itself: of a constraint that is no projection (friction, forces), and where the proxy is the probe.
  virtual PulledBackForce pull_back(const Vec3& probe, const Vec3& f, LinkState& state, LinkScratch& scratch) const noexcept {
    (void)probe, (void)state, (void)scratch;
    return {f};
  }

  /// True where it draws the hand by what it is, rather than holds it: the ledger (passivity.h) grants what it gives.
  virtual bool is_energy_source() const noexcept { return false; }

  /// True for what its ticks can leave in `state.memory` and `state.outer`; false where they would index or branch with something
  /// else. For states that come from a file (check_state.h); off the tick. By default it remembers nothing, so that all is zero.
  virtual bool is_sane(const LinkState& state) const noexcept { return state.memory == decltype(state.memory){}; }

  /// Its domain length L, for tolerances and tests.
  virtual double domain_length() const noexcept { return 4; }
};

}  // namespace catena::haptics
