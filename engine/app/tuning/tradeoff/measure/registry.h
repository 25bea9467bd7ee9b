/// The list of what `catena tradeoff SCENE` measures. A curve more is one file in measure/data, measure/hand or measure/eye and one line
/// in registry.cpp. A measurement answers with as many curves as the scene has things for it; none, with a sentence in
/// Workload::left_out, where it has nothing. An Error is the machine's, and leaves that measurement out.
#pragma once
#include <span>
#include <vector>

#include "engine/app/tuning/tradeoff/measure/workload.h"

namespace catena::app::tradeoff {

struct Measurement {
  const char* name;
  const char* category;  ///< data, hand or eye
  Result<std::vector<Curve>> (*measure)(Workload& subject);
};
std::span<const Measurement> measurements();

// measure/data
Result<std::vector<Curve>> measure_grid_spacing(Workload& subject);   ///< interpolation error by the grid's spacing
Result<std::vector<Curve>> measure_interpolation(Workload& subject);  ///< linear or cubic cells

// measure/hand
Result<std::vector<Curve>> measure_streamline(Workload& subject);
Result<std::vector<Curve>> measure_isosurface(Workload& subject);
Result<std::vector<Curve>> measure_value_precision(Workload& subject);
Result<std::vector<Curve>> measure_tick_rate(Workload& subject);
Result<std::vector<Curve>> measure_chain_length(Workload& subject);

// measure/eye
Result<std::vector<Curve>> measure_quality(Workload& subject);
Result<std::vector<Curve>> measure_ray_step(Workload& subject);
Result<std::vector<Curve>> measure_ray_grid(Workload& subject);
Result<std::vector<Curve>> measure_texel_format(Workload& subject);
Result<std::vector<Curve>> measure_memory_budget(Workload& subject);
Result<std::vector<Curve>> measure_resolution(Workload& subject);

}  // namespace catena::app::tradeoff
