// SPDX-License-Identifier: MIT
/// Which levels of stores are loaded whole. Call it before anything is read.
#pragma once
#include <limits>

namespace catena::field {

/// Loads levels of more than `voxels` in bricks, even where the memory would hold them: for programs that draw, because the first image
/// comes sooner. Does not apply to a level that the request names. Without this call the memory alone decides.
void set_max_whole_level(double voxels);

/// A limit for images on a few processors, and none.
inline constexpr double kMaxDrawnWholeLevel = 512.0 * 512 * 512, kNoMaxWholeLevel = std::numeric_limits<double>::infinity();

}  // namespace catena::field
