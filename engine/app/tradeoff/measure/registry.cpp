#include "engine/app/tradeoff/measure/registry.h"

namespace catena::app::tradeoff {

std::span<const Measurement> measurements() {
  static constexpr Measurement kAll[] = {
      {"interpolation", "data", measure_levels},  {"cells", "data", measure_cells},    {"streamline", "hand", measure_streamline},
      {"isosurface", "hand", measure_isosurface}, {"values", "hand", measure_values},  {"servo rate", "hand", measure_rate},
      {"chain length", "hand", measure_chain},    {"quality", "eye", measure_quality}, {"step", "eye", measure_step},
      {"lattice", "eye", measure_lattice},        {"texels", "eye", measure_texels},   {"memory budget", "eye", measure_budget},
      {"resolution", "eye", measure_resolution},
  };
  return kAll;
}

}  // namespace catena::app::tradeoff
