// SPDX-License-Identifier: MIT
/// Grids of stores of chunks, and which of their levels are loaded whole.
#pragma once
#include <limits>

#include "engine/io/volume/load_field.h"

namespace catena::field {

/// Loads levels of more than `voxels` in bricks, even where the memory would hold them: for programs that draw, because the first image
/// comes sooner. Does not apply to a level that the request names. Without this call the memory alone decides. Call it before anything is
/// read.
void set_max_whole_level(double voxels);

/// A limit for images on a few processors, and none.
inline constexpr double kMaxDrawnWholeLevel = 512.0 * 512 * 512, kNoMaxWholeLevel = std::numeric_limits<double>::infinity();

/// Loads a grid: the finest level that fits into memory, of it the box that the request names; larger levels are read in bricks.
Result<AnyField> load_stored(const LoadRequest& request);

/// Returns whether the file of an array (.raw, .npy) is read as a store: it has more voxels than set_max_whole_level() allows, or than the
/// memory holds.
bool is_read_in_bricks(const LoadRequest& request);

}  // namespace catena::field
