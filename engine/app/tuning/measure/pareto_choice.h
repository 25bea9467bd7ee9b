// SPDX-License-Identifier: MIT
/// Choice of a setting from measured points. Pure functions, any thread.
///   front   points that no other point beats in both error and cost, cheapest first; of equal points the first
///   floor   an error at or below the discretization error cannot be distinguished from it: the cheapest point that reaches it is chosen
///   knee    if no point reaches the floor, or none is known: the point of the front farthest below the chord from its cheapest to its
///            most exact point, both axes logarithmic and scaled to the chord; of a front of two points the more exact one. If no point is
///            at least a tenth of the chord below it, the current setting stays, if it is on the front
///   resolvable  errors below the error of the reference count as equal: for the front, for the knee, and in the stated reason
///   flat    if no setting changes the error, the current setting stays, or else the cheapest is chosen
/// Times whose quartile ranges overlap count as equal: the lower operation count decides, then the lower error, so that noise does not.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "engine/app/tuning/measure/curve.h"

namespace catena::app::tuning {

/// Returns the indices of the front. Points without error or cost, and points that are not selectable, are excluded.
std::vector<int> pareto_front(std::span<const Point> points, CostKind cost);

/// Sets front, chosen, choice_reason and is_flat of the curve.
void choose_setting(Curve& curve);

/// Target of a tuning on a curve: either a maximum error or a maximum cost, in the units of the curve.
struct Target {
  std::optional<double> error, cost;
};
/// The point picked for a target. Errors are resolvable down to the floor and the error of the reference; a lower target counts as that.
///   error  the cheapest point whose error does not exceed it; if there is none, the most exact
///   cost   the least error within it, and of those at the floor the cheapest; if there is none, the cheapest
struct PickedPoint {
  int point = -1;            ///< Index of the point; -1: there is no point to pick.
  bool meets_target = true;  ///< False: no point meets the target, and the nearest one was picked.
  bool at_floor = false;  ///< The target (or the error reached within the cost) is at the limit of what the data or the reference resolve.
};
/// Picks the point of the curve for the target.
PickedPoint pick_point(const Curve& curve, const Target& target);

/// Returns "the discretization error, 0.3"; for a lower bound "the discretization error, at least 0.3".
std::string describe_discretization_error(const Curve& curve);

/// Returns the larger of discretization error and error of the reference, as far as they are known; else 0.
double min_resolvable_error(const Curve& curve);

}  // namespace catena::app::tuning
