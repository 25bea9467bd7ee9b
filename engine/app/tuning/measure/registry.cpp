// SPDX-License-Identifier: MIT
#include "engine/app/tuning/measure/registry.h"

namespace catena::app::tuning {

std::span<const Measurement> measurements() {
  static constexpr Measurement kAll[] = {
      {"interpolation", "data", measure_grid_spacing},
      {"cells", "data", measure_interpolation},
      {"streamline", "hand", measure_streamline},
      {"isosurface", "hand", measure_isosurface},
      {"values", "hand", measure_value_precision},
      {"servo rate", "hand", measure_tick_rate},
      {"chain length", "hand", measure_chain_length},
      {"quality", "eye", measure_quality},
      {"step", "eye", measure_ray_step},
      {"lattice", "eye", measure_ray_grid},
      {"texels", "eye", measure_texel_format},
      {"memory budget", "eye", measure_memory_budget},
      {"resolution", "eye", measure_resolution},
  };
  return kAll;
}

}  // namespace catena::app::tuning
