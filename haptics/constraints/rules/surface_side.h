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

inline constexpr double kLongStep = 0.02;  ///< of L: a longer step of a probe in one tick is a long one, made by a hand or thrown.

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
  SideRules now(LinkState& state, LinkScratch& scratch) const noexcept {
    return {free, release.at(state.proxy, scratch.parameter, state.evaluations)};
  }
  /// The rules at a probe, before there is a proxy.
  SideRules at(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept {
    return {free, release.at(probe, scratch.parameter, state.evaluations)};
  }
};

/// Reads `free` (if asked for) and `release` (which is not the surface's where the link has `snap`: snap.h).
Result<SideSpec> read_side_rules(const json::Node& link, bool has_sides, const BuildContext& context);

/// On which side of a surface a place is.
struct SideValue {
  double value = 0;     ///< value - level
  bool known = false;   ///< false where the field says nothing (outside the mask)
  bool broken = false;  ///< the field is not finite here
};

/// Where a surface holds a probe.
struct Hold {
  bool found = false;            ///< it does hold it
  Vec3 proxy{0.0};               ///< there, world units
  double residual = 0;           ///< the proxy's distance from the surface, world units
  Status status = Status::ok;    ///< how well it holds
  Reason reason = Reason::none;  ///< of a status critical or boundary
};

/// What the rules need to know about a surface. It remembers the point on which it holds from tick to tick.
class Surface {
 public:
  virtual ~Surface() = default;
  /// The side of a place; the rules call it for the probe.
  virtual SideValue side(const Vec3& at) noexcept = 0;
  /// The projection of the probe, with no earlier point to start from.
  virtual Hold place(const Vec3& probe) noexcept = 0;
  /// The closest point reached from the point held before.
  virtual Hold slide(const Vec3& probe) noexcept = 0;
  /// The first crossing of the segment from..probe, moved on to the closest point; not found: no crossing.
  virtual Hold cross(const Vec3& from, const Vec3& probe) noexcept = 0;
  /// As place, but only if that point is at most `limit` away.
  virtual Hold near_by(const Vec3& probe, double limit) noexcept = 0;
  /// Unit normal at the point held, to the side above.
  virtual Vec3 normal() const noexcept = 0;
  /// Whether a step from free to free side may pass through it.
  virtual bool may_be_thin() const noexcept { return false; }
  /// L, world units.
  virtual double domain_length() const noexcept = 0;
};

/// What the rules remember; part of the constraint's memory.
struct SideMemory {
  Vec3 probe{0.0};      ///< the last incoming probe
  Vec3 proxy{0.0};      ///< as it was left, to notice a proxy moved by others
  double value = 0;     ///< at the last probe
  double residual = 0;  ///< of the proxy
  bool known;           ///< `value` means something
  bool fresh;           ///< `probe` and `proxy` mean something
  bool holding;         ///< the surface has a point to go on from
  bool settled;         ///< nothing to gain from another tick at the same probe
  bool sheet;           ///< holding a probe that is beyond the body, where the value is that of the free side
  bool gliding;         ///< holds no more, and is on its way to the probe
  Status status;        ///< of the last tick
  Reason reason;        ///< of the last tick
};

/// Of a state from a file: see Constraint::is_sane.
inline bool is_sane(const SideMemory& m) noexcept {
  return are_bools(m.known, m.fresh, m.holding, m.settled, m.sheet, m.gliding) && is_one_of(m.status, Status::bad_probe) &&
         is_one_of(m.reason, Reason::not_finite);
}

/// How far the proxy may move in this tick, `gap` from its probe; without a last tick, anywhere.
double travel_of(const SideMemory& memory, const Vec3& probe, double gap, const LinkState& state) noexcept;

/// The first tick: Constraint::start for a surface.
void start_on(Surface& surface, const SideRules& rules, const Vec3& probe, SideMemory& memory, LinkState& state) noexcept;
/// One tick: Constraint::advance for a surface.
void advance_on(Surface& surface, const SideRules& rules, const Vec3& probe, SideMemory& memory, LinkState& state) noexcept;

}  // namespace catena::haptics
