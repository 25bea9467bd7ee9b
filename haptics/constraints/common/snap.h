/// Snap and release with hysteresis around any constraint (paper, section 2: taking hold and leaving a feature).
///   apart:  the proxy is the incoming probe x bit for bit, RELEASED; the constraint seeks its closest feature f unseen.
///           Takes hold in the tick in which |x - f| <= snap.
///   held:   the constraint's own proxy p and status. Lets go in the tick in which |x - p| >= release, or in which the constraint finds
///           no feature: RELEASED in that tick, whatever else is near. In the next one another place of the feature may take hold.
/// Keys of every link: `snap` (starts apart, unless the first probe is within it), `release` (default 2 snap; more than snap).
/// `release` alone: starts held, snap = 0.1 release; a type that releases by itself then keeps its own rule. Both may follow a
/// field; where release falls to snap or less, snap counts as 0.9 release. World units.
/// On the free side of a one-sided surface, and where there is no feature, the status is the constraint's.
/// `limit` = release, or the constraint's own where that is smaller. Haptic thread: no allocation, lock or throw. The wrapper's state is
/// LinkState::outer.
#pragma once
#include "haptics/chain/parameter.h"
#include "haptics/constraints/registry.h"

namespace catena::haptics {

struct SnapSpec {
  Parameter snap, release;
  bool has_snap = false;     ///< else 0.1 release, and starts held
  bool has_release = false;  ///< else 2 snap
};

std::shared_ptr<const Constraint> make_snap(std::shared_ptr<const Constraint> inner, const SnapSpec& spec);

/// The constraint wrapped as its link asks for, or itself where it asks for nothing (or releases by itself).
Result<std::shared_ptr<const Constraint>> wrap_snap(const json::Node& link, bool releases_itself, std::shared_ptr<const Constraint> inner,
                                                    const BuildContext& context);

}  // namespace catena::haptics
