// SPDX-License-Identifier: MIT
/// Snap and release with hysteresis around any constraint (paper, section 2: engaging and leaving a feature).
///   released:  the proxy equals the incoming probe x bit for bit, status RELEASED; the constraint seeks its closest feature point f in the
///              background. Engages in the tick in which |x - f| <= snap.
///   engaged:   the constraint's own proxy p and status. Releases in the tick in which |x - p| >= release, or in which the constraint finds
///              no feature: RELEASED in that tick, whatever else is near. In the next tick another point of the feature may engage.
/// Keys of every link: `snap` (starts released, unless the first probe is within it), `release` (default 2 snap; more than snap).
/// `release` alone: starts engaged, snap = 0.1 release; a type that releases by itself then keeps its own rule. Both may follow a
/// field; where release falls to snap or less, snap counts as 0.9 release. World units.
/// On the free side of a one-sided surface, and where there is no feature, the status is that of the constraint.
/// `limit` = release, or the constraint's own limit where that is smaller. The wrapper's state is LinkState::wrapper_memory.
/// Haptic thread: no allocation, lock or throw.
#pragma once
#include "haptics/chain/parameter.h"
#include "haptics/constraints/registry.h"

namespace catena::haptics {

/// Distances of the wrapper as the link states them, world units; may follow a field.
struct SnapSpec {
  Parameter snap, release;
  bool has_snap = false;     ///< false: snap is 0.1 release, and the link starts engaged
  bool has_release = false;  ///< false: release is 2 snap
};

/// Returns the constraint `inner` wrapped in the snap and release rules; `spec` has at least one of the two distances.
std::shared_ptr<const Constraint> make_snap(std::shared_ptr<const Constraint> inner, const SnapSpec& spec);

/// Returns the constraint wrapped as its link states, or `inner` itself if the link has neither key (or only `release`, and
/// `releases_itself`). An Error where a constant `release` is not above `snap`.
Result<std::shared_ptr<const Constraint>> wrap_snap(const json::Node& link, bool releases_itself, std::shared_ptr<const Constraint> inner,
                                                    const BuildContext& context);

}  // namespace catena::haptics
