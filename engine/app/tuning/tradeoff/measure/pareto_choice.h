/// Which setting Catena would choose, from what was measured. Pure functions, any thread.
///   front   points that no other point beats in error and cost at once, cheapest first; of equal ones the first
///   floor   an error at or below it cannot be told from the data's own: the cheapest point that reaches it is chosen
///   knee    where none reaches it, or none is known: the point of the front farthest below the chord from its cheapest to its most
///           exact point, both axes logarithmic and scaled to the chord; of a front of two the more exact one. Where no point is a
///           tenth of the chord below it, what the scene has stays, if it is on the front
///   told    errors below the reference's own are one: for the front, the knee, and what a sentence says of them
///   even    where no setting changes the error, what the scene has stays, or else the cheapest
/// Times whose quartiles overlap are one: then less counted work decides, then less error, so that noise does not.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "engine/app/tuning/tradeoff/measure/curve.h"

namespace catena::app::tradeoff {

/// Points without an error or a cost are left out.
std::vector<int> pareto_front(std::span<const Point> points, CostKind cost);

/// Fills front, chosen, why and even.
void choose_setting(Curve& curve);

/// What a plan wants of a curve: an error, or a cost; one of the two.
struct Target {
  std::optional<double> error, cost;
};
/// What the curve has for it. What can be told of an error ends at the floor, and at the reference's own error: less is never asked for.
///   error  the cheapest point whose error is not above it; where there is none, the most exact
///   cost   the least error within it, and of those at the floor the cheapest; where there is none, the cheapest
struct PickedPoint {
  int point = -1;            ///< -1: there is nothing to choose
  bool meets_target = true;  ///< false: nothing meets the target, the nearest was taken
  bool at_floor = false;     ///< the target lies below what the data, or the reference, hold
};
PickedPoint pick_point(const Curve& curve, const Target& target);

/// "the data's own error, 0.3"; of a lower bound "the data's own error, at least 0.3".
std::string describe_discretization_error(const Curve& curve);

/// The greater of the floor and the reference's own error, as far as they are known; else 0.
double min_resolvable_error(const Curve& curve);

}  // namespace catena::app::tradeoff
