// SPDX-License-Identifier: MIT
/// Colors for labels without a color, as different from each other as possible. Each color is the one farthest from all its predecessors in
/// CIELAB (1976, D65), among colors of medium lightness; lightness counts half, because shading changes it. The first n colors therefore
/// do not depend on the number of labels, and the first 20 are at least 25 apart. Deterministic; any thread.
#pragma once
#include <cstddef>

#include "engine/base/color.h"

namespace catena::scene {

inline constexpr std::size_t kPaletteColors = 256;  ///< The palette repeats after this many colors

/// Returns the color for an index; any index is valid.
Color palette_color(std::size_t index);

}  // namespace catena::scene
