// SPDX-License-Identifier: MIT
/// Contact rules shared by all penetrable surfaces: the free side, release, re-engagement.
///   free = above | below: where value - level has that sign (or is 0) the probe moves freely and the proxy equals the probe bit for
///   bit; a crossing is detected within the tick that makes it.
///   release: the link releases in the tick in which |probe - proxy| >= release. A one-sided link re-engages when its probe is on
///   the free side, a two-sided one when the probe crosses the level or comes within 0.1 release of it.
///   A one-sided link whose first probe is deeper than release starts released.
/// Sheets: the sheet of the surface that holds a one-sided probe is state: the sheet through which the probe entered, followed as the proxy
/// moves. It holds until the probe is in front of that sheet (n . (x - p) >= 0 towards the free side, the proxy at its closest point) or
/// `release` away, however thin the solid is: the space past its far side is not free. A probe that passes through a thin solid within one
/// tick is held likewise (no tunneling). A teleport (a step longer than 0.02 L in one tick and faster than kMaxProbeSpeed, constraint.h) is
/// taken as it is: on the free side the probe is free.
/// Travel: in one tick the proxy moves at most LinkState::max_travel (constraint.h), except on release. Where a hold ends in front of its
/// sheet and far from it, as on noisy data, the proxy glides to the probe at that rate, with status BUDGET.
/// Haptic thread: no allocation, lock, or throw. Lengths in world units.
#pragma once
#include "engine/base/export.h"
#include "haptics/chain/parameter.h"
#include "haptics/constraints/registry.h"

namespace catena::haptics {

/// Fraction of the domain length L: a probe step in one tick above it is a long step, made by fast motion or by a teleport.
inline constexpr double kLongStepFraction = 0.02;

/// Side of the surface that is free: none (two-sided), or the side where the value is above or below the level.
enum class FreeSide { none, above, below };

/// Contact rules of one tick.
struct SideRules {
  FreeSide free = FreeSide::none;  ///< the free side
  double release = 0;              ///< release distance, world units; 0: never releases
};

/// Contact rules as the scene states them.
struct SideSpec {
  FreeSide free = FreeSide::none;  ///< the free side
  Parameter release;               ///< release distance, world units; may follow a field

  /// Returns the rules with `release` evaluated at the last proxy; its field evaluations are counted.
  SideRules rules_at_proxy(LinkState& state, LinkScratch& scratch) const noexcept {
    return {free, release.at(state.proxy, scratch.parameter_cursor, state.evaluations)};
  }
  /// Returns the rules with `release` evaluated at a probe, before there is a proxy.
  SideRules rules_at(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept {
    return {free, release.at(probe, scratch.parameter_cursor, state.evaluations)};
  }
};

/// Reads `free` (if has_sides) and `release` (left at 0 where the link has `snap`, which then releases: snap.h).
CATENA_EXPORT Result<SideSpec> read_side_rules(const json::Node& link, bool has_sides, const BuildContext& context);

/// Value of the surface function at a point, relative to the level.
struct SideValue {
  double value = 0;            ///< value - level
  bool is_known = false;       ///< false where the field has no value (outside the mask)
  bool is_not_finite = false;  ///< the field is not finite at the point
};

/// Result of a closest-point query: the point at which a surface holds a probe.
struct SurfaceHold {
  bool found = false;                      ///< the surface holds the probe
  Vec3 proxy{0.0};                         ///< the closest point, world units
  double residual = 0;                     ///< distance of the proxy from the surface, world units
  LinkStatus status = LinkStatus::ok;      ///< quality of the hold
  SampleStatus reason = SampleStatus::ok;  ///< reason of a status critical or boundary
};

/// Interface of a surface for the contact rules. It keeps the point at which it holds the probe from tick to tick.
class CATENA_EXPORT ContactSurface {
 public:
  virtual ~ContactSurface() = default;
  /// Returns on which side of the surface a point lies; the rules call it with the probe.
  virtual SideValue evaluate_side(const Vec3& at) noexcept = 0;
  /// Returns the closest point to the probe by a search from the probe, without an earlier point to start from.
  virtual SurfaceHold project_probe(const Vec3& probe) noexcept = 0;
  /// Returns the local closest point to the probe, starting from the point held in the last tick.
  virtual SurfaceHold slide(const Vec3& probe) noexcept = 0;
  /// Returns the first crossing of the segment from..probe, moved on to the closest point; not found: no crossing.
  virtual SurfaceHold find_crossing(const Vec3& from, const Vec3& probe) noexcept = 0;
  /// Returns the closest point as project_probe, but not found if it is further than `limit` from the probe.
  virtual SurfaceHold project_probe_within(const Vec3& probe, double limit) noexcept = 0;
  /// Returns the unit normal at the point held, towards the side above.
  virtual Vec3 normal() const noexcept = 0;
  /// Returns whether a probe step from the free side to the free side may pass through the surface.
  virtual bool may_tunnel() const noexcept { return false; }
  /// Returns the domain length L, world units.
  virtual double domain_length() const noexcept = 0;
};

/// State of the contact rules between ticks; part of the constraint's memory.
struct SideMemory {
  Vec3 probe{0.0};      ///< probe of the last tick
  Vec3 proxy{0.0};      ///< proxy as this link left it; another value in LinkState shows that something else moved it
  double value = 0;     ///< value - level at the last probe, if has_value
  double residual = 0;  ///< distance of the proxy from the surface, world units
  bool has_value;       ///< `value` is valid
  bool initialized;     ///< `probe` and `proxy` are valid
  bool holding;         ///< the surface has a point to continue from
  bool settled;         ///< converged: another tick at the same probe changes nothing
  bool beyond_body;     ///< holds a probe past the far side of a thin solid, where the value is that of the free side
  bool gliding;         ///< released by the surface, and the proxy is moving to the probe
  LinkStatus status;    ///< status of the last tick
  SampleStatus reason;  ///< reason of the last tick
};

/// Validates a state from a file: see Constraint::is_sane.
inline bool is_sane(const SideMemory& m) noexcept {
  return are_valid_bools(m.has_value, m.initialized, m.holding, m.settled, m.beyond_body, m.gliding) &&
         is_valid_enum(m.status, LinkStatus::bad_probe) && is_valid_enum(m.reason, SampleStatus::not_finite);
}

/// Returns how far the proxy may move in this tick, world units, where it is `gap` from its probe; infinity before the first tick.
CATENA_EXPORT double max_proxy_travel(const SideMemory& memory, const Vec3& probe, double gap, const LinkState& state) noexcept;

/// Runs the first tick: Constraint::start for a surface.
CATENA_EXPORT void start_on_surface(ContactSurface& surface, const SideRules& rules, const Vec3& probe, SideMemory& memory,
                                    LinkState& state) noexcept;
/// Runs one tick: Constraint::advance for a surface.
CATENA_EXPORT void advance_on_surface(ContactSurface& surface, const SideRules& rules, const Vec3& probe, SideMemory& memory,
                                      LinkState& state) noexcept;

}  // namespace catena::haptics
