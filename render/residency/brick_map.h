/// What rays leap over: maps of the bricks of grids and of packed volumes, and the distances in them.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "render/residency/packed_volume.h"
#include "render/residency/resident_grid.h"

namespace catena::render {

/// How far a ray may leap: for every brick of a grid, x fastest, the largest coordinate difference, in bricks and at most 255, to the
/// nearest brick of another kind. 0: a brick that is never leapt over. OutwardSide the grid nothing is of another kind.
/// `kind`: 0 varies; equal numbers are alike.
std::vector<std::uint8_t> homogeneous_distances(const std::array<std::int32_t, 3>& bricks, const std::vector<std::uint16_t>& kind);

/// Two kinds: active ones, which are never leapt over, and the others.
std::vector<std::uint8_t> empty_distances(const std::array<std::int32_t, 3>& bricks, const std::vector<std::uint8_t>& active);

/// What a ray asks before it samples: one word a brick of 8^3 cells, in an image R32_UINT.
///   bits 0..23: the brick's slot in the atlas (x, y, z, 8 bits each); bits 24..31: 0 if the brick is active, else the distance
///   (largest coordinate difference, in bricks, at most 255) to the nearest active one: all nearer bricks are inactive too.
/// Volumes have their bits 24..31 otherwise: bits 24..30 the distance (at most 127) to the nearest brick of another kind, 0 if the
/// brick varies; bit 31: it is not empty but plain, of one colour and density.
/// Rebuilt when the transfer function or the level changes; the values stay where they are.
struct BrickMap {
  vk::Image image;
  std::uint64_t active_count = 0, total_count = 0;
};

/// `is_active` is asked once for each brick that has a valid cell.
Result<BrickMap> make_brick_map(vk::Device& device, const ResidentGrid& mirror, const std::function<bool(const BrickRange&)>& is_active);

/// `kind` of each brick that has a valid cell: 0 varies, 1 empty, other numbers plain, equal where they look the same. Bricks that are
/// not wholly valid count as varying where they would be plain: with a mask, all of them.
Result<BrickMap> make_skip_map(vk::Device& device, const ResidentGrid& mirror, const std::function<std::uint16_t(const BrickRange&)>& kind);
/// Bits 24..31 as they are given, by brick.
Result<BrickMap> make_brick_word_map(vk::Device& device, const ResidentGrid& mirror, std::span<const std::uint8_t> high);

/// Where a ray may leap: one byte a brick of 4^3 cells, in an image R8_UINT. 0: the transfer function varies in the brick. d > 0: the
/// brick is plain (empty, or of one colour and density), and so, alike, are all bricks nearer than d (largest coordinate
/// difference): a segment within that cube is integrated at once. Rebuilt when the transfer function changes.
struct HomogeneousMap {
  vk::Image image;
  double skippable_share = 0;  ///< share of bricks with d > 0
};

Result<HomogeneousMap> make_homogeneous_map(vk::Device& device, const PackedVolume& packed, const CodeAppearance& looks);

}  // namespace catena::render
