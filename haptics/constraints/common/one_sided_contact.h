/// The rules that all penetrable surfaces share: the free side, letting go, taking hold again.
///   free = above | below: where value - level has that sign (or is 0) the hand moves freely and the proxy is the probe, bit
///   for bit; a crossing is decided within the tick that makes it.
///   release: the link lets go in the tick in which |probe - proxy| >= release. A one-sided link takes hold again when its
///   probe is on the free side, a two-sided one when the probe crosses the level or comes within 0.1 release of it.
///   A one-sided link whose first probe is deeper than release starts released.
/// Sheets: which part of the surface holds a one-sided probe is state: the sheet by which it came in, followed as the proxy moves. It holds
/// until the probe is in front of that sheet again (n . (x - p) >= 0 towards the free side, the proxy at its closest point) or `release`
/// away, however thin the body is: what lies behind its far side is not free. A probe that comes in and out again within one tick is caught
/// likewise. A probe that was thrown (further than 0.02 L in one tick, and faster than a hand, constraint.h) is where it is: on the free
/// side it is free.
/// Travel: in one tick the proxy moves at most |dx| + slip (constraint.h), but for release: a hold that ends in front of its sheet and far
/// from it, as on noisy data, glides to the probe so fast, BUDGET.
/// Haptic thread: no allocation, lock, or throw. Lengths in world units.
#pragma once
#include "haptics/chain/parameter.h"
#include "haptics/constraints/registry.h"

namespace catena::haptics {

inline constexpr double kLongStepFraction = 0.02;  ///< of L: a longer step of a probe in one tick is a long one, made by a hand or thrown.

/// Which side is free: none, or that where the value is above or below the level.
enum class FreeSide { none, above, below };

/// The rules of one tick.
struct SideRules {
  FreeSide free = FreeSide::none;  ///< the free side
  double release = 0;              ///< 0: never lets go
};

/// The rules as the scene states them: `release` may follow a field, asked at the last proxy.
struct SideSpec {
  FreeSide free = FreeSide::none;  ///< the free side
  Parameter release;               ///< may follow a field, world units

  /// The rules at the last proxy.
  SideRules rules_at_proxy(LinkState& state, LinkScratch& scratch) const noexcept {
    return {free, release.at(state.proxy, scratch.parameter_cursor, state.evaluations)};
  }
  /// The rules at a probe, before there is a proxy.
  SideRules rules_at(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept {
    return {free, release.at(probe, scratch.parameter_cursor, state.evaluations)};
  }
};

/// Reads `free` (if asked for) and `release` (which is not the surface's where the link has `snap`: snap.h).
Result<SideSpec> read_side_rules(const json::Node& link, bool has_sides, const BuildContext& context);

/// On which side of a surface a place is.
struct SideValue {
  double value = 0;            ///< value - level
  bool is_known = false;       ///< false where the field says nothing (outside the mask)
  bool is_not_finite = false;  ///< the field is not finite here
};

/// Where a surface holds a probe.
struct SurfaceHold {
  bool found = false;                      ///< it does hold it
  Vec3 proxy{0.0};                         ///< there, world units
  double residual = 0;                     ///< the proxy's distance from the surface, world units
  LinkStatus status = LinkStatus::ok;      ///< how well it holds
  SampleStatus reason = SampleStatus::ok;  ///< of a status critical or boundary
};

/// What the rules need to know about a surface. It remembers the point on which it holds from tick to tick.
class ContactSurface {
 public:
  virtual ~ContactSurface() = default;
  /// The side of a place; the rules call it for the probe.
  virtual SideValue evaluate_side(const Vec3& at) noexcept = 0;
  /// The projection of the probe, with no earlier point to start from.
  virtual SurfaceHold project_probe(const Vec3& probe) noexcept = 0;
  /// The closest point reached from the point held before.
  virtual SurfaceHold slide(const Vec3& probe) noexcept = 0;
  /// The first crossing of the segment from..probe, moved on to the closest point; not found: no crossing.
  virtual SurfaceHold find_crossing(const Vec3& from, const Vec3& probe) noexcept = 0;
  /// As place, but only if that point is at most `limit` away.
  virtual SurfaceHold project_probe_within(const Vec3& probe, double limit) noexcept = 0;
  /// Unit normal at the point held, to the side above.
  virtual Vec3 normal() const noexcept = 0;
  /// Whether a step from free to free side may pass through it.
  virtual bool may_tunnel() const noexcept { return false; }
  /// L, world units.
  virtual double domain_length() const noexcept = 0;
};

/// What the rules remember; part of the constraint's memory.
struct SideMemory {
  Vec3 probe{0.0};      ///< the last incoming probe
  Vec3 proxy{0.0};      ///< as it was left, to notice a proxy moved by others
  double value = 0;     ///< at the last probe
  double residual = 0;  ///< of the proxy
  bool has_value;       ///< `value` means something
  bool initialized;     ///< `probe` and `proxy` mean something
  bool holding;         ///< the surface has a point to go on from
  bool settled;         ///< nothing to gain from another tick at the same probe
  bool beyond_body;     ///< holding a probe that is beyond the body, where the value is that of the free side
  bool gliding;         ///< holds no more, and is on its way to the probe
  LinkStatus status;    ///< of the last tick
  SampleStatus reason;  ///< of the last tick
};

/// Of a state from a file: see Constraint::is_valid_state.
inline bool is_sane(const SideMemory& m) noexcept {
  return are_valid_bools(m.has_value, m.initialized, m.holding, m.settled, m.beyond_body, m.gliding) &&
         is_valid_enum(m.status, LinkStatus::bad_probe) && is_valid_enum(m.reason, SampleStatus::not_finite);
}

/// How far the proxy may move in this tick, `gap` from its probe; without a last tick, anywhere.
double max_proxy_travel(const SideMemory& memory, const Vec3& probe, double gap, const LinkState& state) noexcept;

/// The first tick: Constraint::start for a surface.
void start_on_surface(ContactSurface& surface, const SideRules& rules, const Vec3& probe, SideMemory& memory, LinkState& state) noexcept;
/// One tick: Constraint::advance for a surface.
void advance_on_surface(ContactSurface& surface, const SideRules& rules, const Vec3& probe, SideMemory& memory, LinkState& state) noexcept;

}  // namespace catena::haptics
