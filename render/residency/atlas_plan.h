/// Which bricks of a grid the atlas of its mirror stores, and where: a brick whose 9^3 voxels are one value shares its slot with those of
/// the same value. Any thread.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "render/residency/resident_grid.h"

namespace catena::render {

struct AtlasPlan {
  field::Index3 origin;                   ///< voxel of the first brick: the leaf that holds the box's corner
  std::array<std::int32_t, 3> bricks{};   ///< an axis
  std::vector<std::uint8_t> is_constant;  ///< a brick, x fastest
  std::vector<float> constant_values;
  std::size_t stored_count = 0;  ///< bricks that are not constant

  field::Index3 first_voxel(std::size_t brick) const;
};
AtlasPlan plan_atlas(const field::ScalarGrid& grid, const field::Index3& first, const std::array<std::int32_t, 3>& bricks);

struct AtlasSlots {
  std::array<std::uint32_t, 3> slots_per_axis{};
  std::vector<std::size_t> slot_bricks;    ///< of each slot that is in use
  std::vector<std::uint32_t> brick_words;  ///< a brick: ResidentGrid::slots
};
/// The error ends a sentence: brick_slots.h.
Result<AtlasSlots> assign_slots(const vk::Device& device, const AtlasPlan& plan);

}  // namespace catena::render
