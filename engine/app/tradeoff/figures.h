/// The figures that `catena tradeoff --figure N` measures: tables, a gnuplot script, plots.
///   2  drift of the linear follow mode and of higher-order methods from the streamline (section 4)
///   3  a penetrable surface and a curve: the baselines' one proxy beside the chain (section 5)
///   stiffness  the largest spring that a device can show, by damping, rate and delay, beside the passive limit
#pragma once
#include "engine/app/tradeoff/results.h"

namespace catena::app {

Outcome figure2(ResultFolder& folder);
Outcome figure3(ResultFolder& folder);
Outcome figure_stiffness(ResultFolder& folder);

}  // namespace catena::app
