// SPDX-License-Identifier: MIT
/// Timing that is robust against load on the system: the settings of a curve run interleaved, each round starting with another one. The
/// time of a setting is the median over its rounds, its spread the quartiles. Processor time where the processor does the work.
#pragma once
#include <functional>
#include <vector>

#include "engine/app/tuning/measure/curve.h"
#include "engine/base/result.h"

namespace catena::app::tuning {

/// One timed run of a setting; returns its duration in the unit of the curve.
using TimedRun = std::function<Result<double>()>;

/// Times the settings in rounds until `seconds` of wall time have passed, at least three rounds (one, if that takes twice as long) and at
/// most `max_repeats`. The first round is a warm-up and does not count. An Error if a run fails.
Result<std::vector<Timing>> time_interleaved(const std::vector<TimedRun>& settings, double seconds, int max_repeats = 31);

/// The same, written to the points of a curve; `repeats` has one run per point, in order.
Outcome time_points(Curve& curve, const std::vector<TimedRun>& repeats, double seconds, int max_repeats = 31);

/// Returns median and quartiles; NaN for an empty list.
Timing compute_timing(std::vector<double> times);

}  // namespace catena::app::tuning
