// SPDX-License-Identifier: MIT
/// Interface of every constraint, state of a link between ticks, and limits of a device.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <limits>
#include <new>
#include <type_traits>

#include "engine/base/export.h"
#include "engine/base/haptic_state.h"
#include "engine/base/result.h"
#include "engine/field/field.h"
#include "engine/widget/widget.h"
#include "haptics/chain/state_hash.h"

namespace catena::haptics {

/// Limits set by the device, not by the scene. By default no limit applies, as in a `replay` without a device. Meters of probe travel
/// (device scale applied), newtons.
struct DeviceLimits {
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();  ///< value that means no limit

  double max_stiffness_n_per_m = kUnlimited;                ///< maximum of every k_i
  double max_rotational_stiffness_nm_per_rad = kUnlimited;  ///< maximum of every kappa_i
  double max_force_n = kUnlimited;                          ///< maximum of |F|; the direction is kept
  double max_torque_nm = kUnlimited;                        ///< maximum of |torque|; the direction is kept
  double slew_n_per_s = kUnlimited;                         ///< maximum of |dF/dt|; never delays the drop to zero on a fault
  double ramp_in_s = 0;                                     ///< time in which the force rises from 0 to 1 after it is switched on
  double ramp_out_s = 0.02;                        ///< time in which the force falls to zero after too many late ticks or a switch-off
  int max_late_ticks = 5;                          ///< number of late ticks in a row that hold the last force; after more it is ramped out
  bool passivity_control = false;                  ///< the passivity controller acts (passivity.h)
  double damping_ns_per_m = 0;                     ///< damping of the device itself, which the passivity observer counts on
  double delay_s = 0;                              ///< delay from the pose to the force; the observer counts the force that acted
  double max_added_damping_ns_per_m = kUnlimited;  ///< maximum damping that the passivity controller adds; more shakes a light device
};

inline constexpr int kMaxEvaluations = 257;  ///< maximum number of field samples per link and tick, for every method
/// Work units of a link and tick: everything that takes time is counted in units of about 20 ns. A field sample counts kFetchWork (plus
/// kCellWork for a cell anywhere in a grid, plus kCubicWork for a cubic one); every evaluation of a cell's polynomial, every search node,
/// knot or face that is visited counts 1. A constraint stops before kMaxWork with BUDGET and resumes in the next tick.
inline constexpr int kMaxWork = 4096, kFetchWork = 7, kCellWork = 8, kCubicWork = 16;  ///< work units
inline constexpr int kReservedWork = 256;  ///< part of kMaxWork reserved for finishing a step that has begun
/// Fraction of max_force by which extra proxy travel may change the force in one tick, so that together with the motion of the probe the
/// change stays below 5 %.
inline constexpr double kSlipFraction = 0.04;
inline constexpr double kRearmFraction = 0.1;  ///< fraction of `release` within which a released link re-engages
inline constexpr double kMaxProbeSpeed = 15;   ///< m/s; a probe that moves faster is treated as a teleport

/// Returns whether two vectors are bit-identical: -0 differs from 0, and a NaN equals itself.
inline bool bitwise_equal(const Vec3& a, const Vec3& b) noexcept { return std::memcmp(&a, &b, sizeof a) == 0; }

/// State of a link between ticks: plain data, copied bit for bit into recordings. Only the haptic thread changes it.
struct LinkState {
  Vec3 proxy{0.0};                                   ///< position to which the constraint holds the probe, world units
  double residual = 0;                               ///< distance of the proxy from the constraint, world units
  double limit = 0;                                  ///< |probe - proxy| at which the link slips or releases, world units; 0: never
  double dt_s = 0;                                   ///< time since the last tick, seconds; 0 in the first
  double stiffness_n_per_m = 0;                      ///< k_i in this tick
  double max_probe_step = 0;                         ///< longest path of the probe in this tick, kMaxProbeSpeed dt / S, world units
  std::int32_t evaluations = 0;                      ///< number of field samples in this tick
  std::int32_t other_work = 0;                       ///< other counted work in this tick, work units
  std::int32_t max_work = kMaxWork - kReservedWork;  ///< maximum work of this tick, work units; a constraint may lower it
  /// Allowed extra proxy travel in this tick, beyond that of its probe, world units: kSlipFraction max_force / (k_i S).
  double max_slip = std::numeric_limits<double>::infinity();
  std::int32_t curve_index = -1;           ///< index of the curve, in a file of curves, to which the link is constrained; -1: none
  LinkStatus status = LinkStatus::ok;      ///< status of the link
  SampleStatus reason = SampleStatus::ok;  ///< cause of the status critical or boundary; not valid with another status
  bool started = false;                    ///< `start` has been called
  bool released = false;                   ///< the link is released; it re-engages by the constraint's own rule
  bool switched_on = false;                ///< the link's switch is on
  bool data_changed = false;               ///< other values are in memory around the chain than in the last tick (bricks.h)
  bool is_coarse = false;                  ///< the last field samples were of a coarser level of the data
  double weight = 1;                       ///< weight w_i of the force law, 0..1
  widget::LinkShape shape{};               ///< link of a widget: shape in this tick (widgets.h)
  alignas(16) std::array<std::byte, 1024> memory{};         ///< private memory of the constraint, zero at start; see memory_as
  alignas(16) std::array<std::byte, 128> wrapper_memory{};  ///< private memory of a wrapping constraint, zero at start

  /// Returns the proxy travel limit of a tick in which the probe moves by `moved` and is at the distance `gap`, world units. A gap larger
  /// than max_force allows still gives max_force: there travel of the fraction kSlipFraction of the gap turns the force no more than
  /// max_slip would change it.
  double max_travel(double moved, double gap) const { return moved + std::max(max_slip, kSlipFraction * gap); }
  /// Returns whether the link is switched on and not released.
  bool active() const { return switched_on && !released; }
  /// Returns the work of this tick so far, work units.
  int work() const { return kFetchWork * evaluations + other_work; }
  /// Returns how many of `requested` steps (one work unit each) the budget still allows.
  int affordable_steps(int requested) const { return std::max(0, std::min(requested, max_work - work())); }
  /// Returns whether at most `reserve` work units are left.
  bool exhausted(int reserve = 0) const { return work() + reserve >= max_work; }
  /// Resets the counters and curve_index, before a tick.
  void begin_tick() {
    evaluations = other_work = 0;
    max_work = kMaxWork - kReservedWork;
    curve_index = -1;
  }
};
static_assert(std::is_trivially_copyable_v<LinkState>);

/// Sets status and reason together, where the field ends a motion.
inline void set_link_status(LinkState& state, LinkStatus status, SampleStatus reason) noexcept {
  state.status = status;
  state.reason = reason;
}

/// Returns the constraint's private memory in the state as its own plain struct T (all zero bytes must be a valid T).
template <class T>
T& memory_as(LinkState& state) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= sizeof(state.memory) && alignof(T) <= 16);
  return *std::launder(reinterpret_cast<T*>(state.memory.data()));
}

/// Returns the private memory of a constraint that wraps another one; the wrapped constraint uses `memory`.
template <class T>
T& wrapper_memory_as(LinkState& state) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= sizeof(state.wrapper_memory) && alignof(T) <= 16);
  return *std::launder(reinterpret_cast<T*>(state.wrapper_memory.data()));
}

/// Returns the constraint's private memory, read-only.
template <class T>
const T& memory_as(const LinkState& state) {
  return memory_as<T>(const_cast<LinkState&>(state));
}
/// Returns the wrapping constraint's private memory, read-only.
template <class T>
const T& wrapper_memory_as(const LinkState& state) {
  return wrapper_memory_as<T>(const_cast<LinkState&>(state));
}

/// Caches of a link that never change a result. Haptic thread.
struct LinkScratch {
  std::array<field::Cursor, 4> cursors{};                ///< cursors of the constraint
  field::Cursor parameter_cursor{}, stiffness_cursor{};  ///< cursors of the constraint's parameters and of the link's stiffness

  /// Calls visit(cursor) for all cursors.
  template <class Visit>
  void for_cursors(const Visit& visit) {
    for (field::Cursor& cursor : cursors) visit(cursor);
    visit(parameter_cursor);
    visit(stiffness_cursor);
  }
};

/// Haptic primitive: linear approximation of a constraint near a point, as used by the baselines of the paper's section 3.
///   point: p = origin;   line: p = origin + s axis;   plane: axis . (p - origin) = 0
struct Primitive {
  /// Set of positions that the primitive leaves free: a point, a line, a plane.
  enum class Kind { point, line, plane };
  Kind kind = Kind::point;  ///< equation that holds
  Vec3 origin{0.0};         ///< point on the primitive, world units
  Vec3 axis{0.0};           ///< unit: direction of a line, normal of a plane
};

/// Force pulled back to the probe, and the part truncated by the bound of J (haptics/constraints/common/pull_back.h). Newtons.
struct PulledBackForce {
  Vec3 force{0.0};      ///< J^T f with bounded J
  Vec3 truncated{0.0};  ///< unbounded J^T f minus `force`; zero where J is within its bound
};

/// Interface of every constraint (paper, section 3): the rule that moves a proxy. A class derived from it and described by a ConstraintType
/// (haptics/constraints/registry.h) can be used in scenes. A Constraint object is the immutable specification, created off the tick; state
/// that changes from tick to tick is in LinkState (plain data), caches that never change a result are in LinkScratch.
/// `start` and `advance` run on the haptic thread: no allocation, lock, throw or unbounded loop; equal input gives bit-identical results.
class CATENA_EXPORT Constraint {
 public:
  virtual ~Constraint() = default;
  Constraint() = default;
  Constraint(const Constraint&) = delete;
  Constraint& operator=(const Constraint&) = delete;

  /// Initializes the proxy before the link's first tick (seed, or projection of the first incoming probe); may set `released`. The field
  /// samples count in the first tick's `state.evaluations`, to which `advance` adds.
  virtual void start(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept = 0;

  /// Runs one tick: moves state.proxy according to the (finite) incoming probe; sets status, residual and released and adds to evaluations.
  /// Where the constraint does not hold (released, free side, no surface) the proxy equals the probe bit for bit.
  virtual void advance(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept = 0;

  /// Computes the linear primitive that approximates the constraint near `at`, world units; field samples are counted. Returns false if the
  /// constraint has none (friction, forces), or none there. `state` is the link's own, as `advance` left it.
  virtual bool primitive(const Vec3& at, LinkState& state, LinkScratch& scratch, Primitive& out) const noexcept {
    (void)at, (void)state, (void)scratch, (void)out;
    return false;
  }
  /// Returns whether `primitive` is implemented, which the baselines require.
  virtual bool has_primitive() const noexcept { return false; }

  /// Moves the proxy to the closest point of the feature, wherever it was, while a link that snaps waits to engage: called in every tick
  /// instead of `advance`, and before the first `start` (`memory` is zero then). A constraint with many local minima may spread the search
  /// over several ticks.
  virtual void seek(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept { start(probe, state, scratch); }

  /// Returns the force on the probe that corresponds to the force f on the proxy, by virtual work: J^T f with J = dp/dx, at the state that
  /// `advance` left. Field samples are counted. By default f itself, for a constraint that is no projection (friction, forces) and where
  /// the proxy is the probe.
  virtual PulledBackForce pull_back(const Vec3& probe, const Vec3& f, LinkState& state, LinkScratch& scratch) const noexcept {
    (void)probe, (void)state, (void)scratch;
    return {f};
  }

  /// Returns whether the constraint drives the probe by design instead of holding it; its energy is then exempt (passivity.h).
  virtual bool is_energy_source() const noexcept { return false; }

  /// Returns whether state.memory and state.wrapper_memory hold what the constraint's ticks can leave there, so that ticks can safely index
  /// and branch with it. For states read from a file (validate_state.h); off the tick. By default the constraint uses no memory, which must
  /// be zero.
  virtual bool is_sane(const LinkState& state) const noexcept { return state.memory == decltype(state.memory){}; }

  /// Returns the length L of the constraint's domain, for tolerances and tests, world units.
  virtual double domain_length() const noexcept { return 4; }
};

}  // namespace catena::haptics
