// SPDX-License-Identifier: MIT
/// Registry of the measurements of `catena tradeoff SCENE`. To add one, add a file in measure/data, measure/haptics or measure/rendering
/// and a line in registry.cpp. A measurement returns one curve per item of the scene it applies to; none, with a sentence in
/// Workload::skipped, if there is no such item. An Error is a failure of the system and omits that measurement.
#pragma once
#include <span>
#include <vector>

#include "engine/app/tuning/measure/workload.h"

namespace catena::app::tuning {

/// One measurement.
struct Measurement {
  const char* name;
  const char* category;  ///< "data", "hand" (haptics) or "eye" (rendering).
  Result<std::vector<Curve>> (*measure)(Workload& subject);
};
/// Returns all measurements, in the order in which they run.
std::span<const Measurement> measurements();

// measure/data
Result<std::vector<Curve>> measure_grid_spacing(Workload& subject);   ///< Interpolation error against grid spacing.
Result<std::vector<Curve>> measure_interpolation(Workload& subject);  ///< Linear against cubic interpolation.

// measure/haptics
Result<std::vector<Curve>> measure_streamline(Workload& subject);
Result<std::vector<Curve>> measure_isosurface(Workload& subject);
Result<std::vector<Curve>> measure_value_precision(Workload& subject);
Result<std::vector<Curve>> measure_tick_rate(Workload& subject);
Result<std::vector<Curve>> measure_chain_length(Workload& subject);

// measure/rendering
Result<std::vector<Curve>> measure_quality(Workload& subject);
Result<std::vector<Curve>> measure_ray_step(Workload& subject);
Result<std::vector<Curve>> measure_ray_grid(Workload& subject);
Result<std::vector<Curve>> measure_texel_format(Workload& subject);
Result<std::vector<Curve>> measure_memory_budget(Workload& subject);
Result<std::vector<Curve>> measure_resolution(Workload& subject);

}  // namespace catena::app::tuning
