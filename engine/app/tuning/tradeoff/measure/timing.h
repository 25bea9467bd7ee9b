/// Times that a busy machine does not decide: the settings of a curve are run in turns, each round beginning with another one, and a
/// setting's time is the median of its rounds, its spread their quartiles. Processor time where the processor does the work.
#pragma once
#include <functional>
#include <vector>

#include "engine/app/tuning/tradeoff/measure/curve.h"
#include "engine/base/result.h"

namespace catena::app::tradeoff {

/// One repeat of a setting: what it took, in the unit of the curve.
using TimedRun = std::function<Result<double>()>;

/// Rounds until `seconds` of wall time are over, three at least (one, where that takes twice as long) and `most` at most. The first round
/// warms up and does not count.
Result<std::vector<Timing>> time_interleaved(const std::vector<TimedRun>& settings, double seconds, int most = 31);

/// The same into the points of a curve; a repeat is one of each, in their order.
Outcome time_points(Curve& curve, const std::vector<TimedRun>& repeats, double seconds, int most = 31);

/// Median and quartiles; not finite of nothing.
Timing compute_timing(std::vector<double> times);

}  // namespace catena::app::tradeoff
