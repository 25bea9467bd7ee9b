// SPDX-License-Identifier: MIT
/// Selected streamline: the proxy is an arc length s on an immutable curve; no field samples in a tick (0 evaluations).
///   g(s) = (x - c(s)) . c'(s);  march knot by knot to where g changes sign, then the root of g on that interval's Hermite interpolant.
/// The root is always bracketed by the interval's two knots, so it does not depend on the proxy's history: sweeping back and forth gives
/// the same bits. Open ends hold with BOUNDARY or CRITICAL; closed curves wrap. At most 4096 knots per tick, then BUDGET, and the march
/// resumes in the next tick. While a link that snaps is released it seeks the nearest point of the whole curve
/// (engine/geometry/flow/curve.h). Haptic thread: no allocation, lock or throw.
#pragma once
#include "engine/base/export.h"
#include "engine/geometry/flow/curve.h"
#include "haptics/chain/constraint.h"

namespace catena::haptics {

/// Returns J^T f of the closest point of a traced curve, at s in the given interval: J = p' p'^T / (p' . p' - (x - p) . p''), of the cubic
/// that it is on; 0 at an open end (common/pull_back.h).
CATENA_EXPORT PulledBackForce pull_back_on_curve(const flow::Curve& curve, std::size_t interval, double s, const Vec3& probe,
                                                 const Vec3& f) noexcept;

/// State of the link between ticks.
struct SelectedStreamlineMemory {
  double s = 0;                    ///< arc length of the proxy, world units
  std::uint64_t interval = 0;      ///< index of the knot interval that contains s
  std::int32_t knots_visited = 0;  ///< knots visited in the last tick: its work
};

/// Returns the constraint that holds its probe on a curve. Off the tick.
CATENA_EXPORT std::shared_ptr<const Constraint> make_selected_streamline(flow::CurvePtr curve);

}  // namespace catena::haptics
