/// The list of what `catena tradeoff SCENE` measures. A curve more is one file in measure/data, measure/hand or measure/eye and one line
/// in registry.cpp. A measurement answers with as many curves as the scene has things for it; none, with a sentence in
/// Subject::left_out, where it has nothing. An Error is the machine's, and leaves that measurement out.
#pragma once
#include <span>
#include <vector>

#include "engine/app/tradeoff/measure/subject.h"

namespace catena::app::tradeoff {

struct Measurement {
  const char* name;
  const char* part;  ///< data, hand or eye
  Result<std::vector<Curve>> (*measure)(Subject& subject);
};
std::span<const Measurement> measurements();

// measure/data
Result<std::vector<Curve>> measure_levels(Subject& subject);  ///< interpolation error by the grid's spacing
Result<std::vector<Curve>> measure_cells(Subject& subject);   ///< linear or cubic cells

// measure/hand
Result<std::vector<Curve>> measure_streamline(Subject& subject);
Result<std::vector<Curve>> measure_isosurface(Subject& subject);
Result<std::vector<Curve>> measure_values(Subject& subject);
Result<std::vector<Curve>> measure_rate(Subject& subject);
Result<std::vector<Curve>> measure_chain(Subject& subject);

// measure/eye
Result<std::vector<Curve>> measure_quality(Subject& subject);
Result<std::vector<Curve>> measure_step(Subject& subject);
Result<std::vector<Curve>> measure_lattice(Subject& subject);
Result<std::vector<Curve>> measure_texels(Subject& subject);
Result<std::vector<Curve>> measure_budget(Subject& subject);
Result<std::vector<Curve>> measure_resolution(Subject& subject);

}  // namespace catena::app::tradeoff
