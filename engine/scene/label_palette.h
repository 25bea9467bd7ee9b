/// Colours for labels that have none: as different from each other as a few can be. Of colours of middle lightness the next one is that
/// farthest from all before it in CIELAB (1976, D65), where lightness counts half, for shading changes it. The first n are therefore the
/// same whatever n is, and the first 20 are at least 25 apart. Deterministic; any thread.
#pragma once
#include <cstddef>

#include "engine/base/color.h"

namespace catena::scene {

inline constexpr std::size_t kPaletteColors = 256;  ///< then they come again

Color palette_color(std::size_t index);

}  // namespace catena::scene
