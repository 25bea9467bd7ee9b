// SPDX-License-Identifier: MIT
/// Tubes colored by the values at their points. Pure functions, any thread.
#pragma once
#include <span>
#include <vector>

#include "render/extract/extract_internal.h"
#include "render/extract/threshold.h"

namespace catena::render {

/// Appends the tube, colored by the values at its points; with a threshold only its parts within it, each a tube of its own. Returns the
/// parts, one a tube that was appended.
std::vector<LinePart> add_colored_tubes(const TubeItem& tube, std::span<const double> values, const ColorTable& table,
                                        const Threshold& threshold, std::vector<TubeItem>& out);

}  // namespace catena::render
