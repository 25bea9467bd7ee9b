/// The figures of the paper that `catena tradeoff --figure N` measures: tables, a gnuplot script, plots.
///   2  drift of the linear follow mode and of higher-order methods from the streamline (section 4)
///   3  a penetrable surface and a curve: the baselines' one proxy beside the chain (section 5)
#pragma once
#include "engine/app/tradeoff/results.h"

namespace catena::app {

Outcome figure2(ResultFolder& folder);
Outcome figure3(ResultFolder& folder);

}  // namespace catena::app
