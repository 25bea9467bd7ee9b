// SPDX-License-Identifier: MIT
/// Where the light that arrives in the scene is looked up: from render/light to the rays.
#pragma once
#include <cstdint>

#include "engine/base/vec.h"

namespace catena::render {

/// Place of the light that arrives in the scene (render/light): a box along the world's axes.
struct LightPlace {
  Vec3 lo{0.0}, size{0.0};    ///< display units
  double cell = 0;            ///< edge of a cell, display units
  double surface_offset = 0;  ///< distance from a surface, along its normal, at which light is looked up
  int planes = 0;             ///< number of planes of cells along z
  std::uint32_t version = 0;  ///< changes with the light; 0: nothing is cast
};

}  // namespace catena::render
