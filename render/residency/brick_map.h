// SPDX-License-Identifier: MIT
/// Maps for empty-space skipping: the bricks of resident grids and of packed volumes, with the distances that rays may skip.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "render/residency/packed_volume.h"
#include "render/residency/resident_grid.h"

namespace catena::render {

/// Returns how far a ray may skip: for every brick of a grid, x fastest, the maximum coordinate difference, in bricks and at most 255, to
/// the nearest brick of another kind. 0: the brick must not be skipped. Outside the grid nothing counts as another kind. `kind`: 0 varies;
/// equal numbers mean equal appearance.
std::vector<std::uint8_t> homogeneous_distances(const std::array<std::int32_t, 3>& bricks, const std::vector<std::uint16_t>& kind);

/// Returns homogeneous_distances() for two kinds: active bricks, which are never skipped, and the others.
std::vector<std::uint8_t> empty_distances(const std::array<std::int32_t, 3>& bricks, const std::vector<std::uint8_t>& active);

/// Brick map that a ray reads before it samples: one word per brick of 8^3 cells, in an image R32_UINT.
///   bits 0..23: the brick's slot in the atlas (x, y, z, 8 bits each); bits 24..31: 0 if the brick is active, else the distance
///   (maximum coordinate difference, in bricks, at most 255) to the nearest active one: all nearer bricks are inactive, too.
/// For volumes, bits 24..31 differ: bits 24..30 are the distance (at most 127) to the nearest brick of another kind, 0 if the brick varies;
/// bit 31: the brick is not empty but homogeneous, with one color and extinction. Rebuilt when the transfer function or the level changes;
/// the values on the device are unaffected.
struct BrickMap {
  vk::Image image;
  std::uint64_t active_count = 0, total_count = 0;
};

/// Builds the map of active bricks. `is_active` is called once for each brick with a valid cell; others are inactive.
Result<BrickMap> make_brick_map(vk::Device& device, const ResidentGrid& resident, const std::function<bool(const BrickRange&)>& is_active);

/// Builds the map of a volume. `kind` is called for each brick with a valid cell: 0 varies, 1 empty, other numbers homogeneous, equal if
/// the appearance is equal. Bricks that are not completely valid count as varying instead of homogeneous: with a mask, all of them.
Result<BrickMap> make_skip_map(vk::Device& device, const ResidentGrid& resident,
                               const std::function<std::uint16_t(const BrickRange&)>& kind);
/// Builds the map with the given bits 24..31, by brick.
Result<BrickMap> make_brick_word_map(vk::Device& device, const ResidentGrid& resident, std::span<const std::uint8_t> high);

/// Map of homogeneous bricks of a packed volume: one byte per brick of 4^3 cells, in an image R8_UINT. 0: the transfer function varies in
/// the brick. d > 0: the brick is homogeneous (empty, or of one color and extinction), and so, with the same appearance, are all bricks
/// nearer than d (maximum coordinate difference): a segment within that cube is integrated in one step. Rebuilt when the transfer function
/// changes.
struct HomogeneousMap {
  vk::Image image;
  double skippable_share = 0;  ///< share of bricks with d > 0
};

/// Builds the map. `appearance`: appearance of the codes.
Result<HomogeneousMap> make_homogeneous_map(vk::Device& device, const PackedVolume& packed, const CodeAppearance& appearance);

}  // namespace catena::render
