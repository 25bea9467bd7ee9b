// SPDX-License-Identifier: MIT
/// Plan of a brick atlas: which bricks of a grid its resident copy stores, and where. Bricks whose 9^3 voxels all have one value share a
/// slot with the others of the same value. Any thread.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "render/residency/resident_grid.h"

namespace catena::render {

/// Classification of the bricks of a grid.
struct AtlasPlan {
  field::Index3 origin;                   ///< voxel of the first brick: origin of the leaf that contains the box corner
  std::array<std::int32_t, 3> bricks{};   ///< bricks per axis
  std::vector<std::uint8_t> is_constant;  ///< per brick, x fastest
  std::vector<float> constant_values;
  std::size_t stored_count = 0;  ///< number of bricks that are not constant

  /// Returns the first voxel of a brick.
  field::Index3 first_voxel(std::size_t brick) const;
};
/// Plans the bricks of `bricks` leaves per axis from voxel `first` on.
AtlasPlan plan_atlas(const field::ScalarGrid& grid, const field::Index3& first, const std::array<std::int32_t, 3>& bricks);

/// Slots of the stored bricks.
struct AtlasSlots {
  std::array<std::uint32_t, 3> slots_per_axis{};
  std::vector<std::size_t> slot_bricks;    ///< brick stored in each used slot
  std::vector<std::uint32_t> brick_words;  ///< per brick: see ResidentGrid::brick_slots
};
/// Assigns the slots. The Error's text is the end of a message (brick_slots.h).
Result<AtlasSlots> assign_slots(const vk::Device& device, const AtlasPlan& plan);

}  // namespace catena::render
