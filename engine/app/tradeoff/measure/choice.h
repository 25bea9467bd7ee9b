/// Which setting Catena would choose, from what was measured. Pure functions, any thread.
///   front   points that no other point beats in error and cost at once, cheapest first; of equal ones the first
///   floor   an error at or below it cannot be told from the data's own: the cheapest point that reaches it is chosen
///   knee    where none reaches it, or none is known: the point of the front farthest below the chord from its cheapest to its most
///           exact point, both axes logarithmic and scaled to the chord; of a front of two the more exact one. Where no point is a
///           tenth of the chord below it, what the scene has stays, if it is on the front
///   even    where no setting changes the error, what the scene has stays, or else the cheapest
/// Times whose quartiles overlap are one: then less counted work decides, then less error, so that noise does not.
#pragma once
#include <span>
#include <vector>

#include "engine/app/tradeoff/measure/curve.h"

namespace catena::app::tradeoff {

/// Points without an error or a cost are left out.
std::vector<int> pareto_front(std::span<const Point> points, Cost cost);

/// Fills front, chosen and why.
void choose(Curve& curve);

}  // namespace catena::app::tradeoff
