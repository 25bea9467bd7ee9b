// SPDX-License-Identifier: MIT
/// Levels of a grid in the description of a store.
#pragma once
#include <string>

#include "engine/io/stores/store_protocol.h"

namespace catena::chunks {

/// Returns the level with axis-parallel voxels: spacing, and world position of voxel (0, 0, 0). Where the spacing is 0 it is that of level
/// 0 of `grid` times the ratio of their sizes, and the outer faces of both coincide; 1 in level 0.
field::StoreLevel make_level(const field::StoreGrid& grid, const field::Index3& size, const field::Index3& chunk, Vec3 spacing,
                             Vec3 origin);

/// Removes the levels of a grid that are not coarser than level 0, or elsewhere in the world by more than two of their voxels. Returns a
/// note; empty: none was removed.
std::string remove_misplaced_levels(field::StoreGrid& grid);

/// Returns a name for a grid that none of the store's grids has.
std::string unique_name(const field::StoreDescription& store, const std::string& name);

}  // namespace catena::chunks
