// SPDX-License-Identifier: MIT
/// Large scalar grid packed for the fast raycast: only what is visible under the transfer function, as bricks of 8^3 cells in one image. A
/// word of 16 bits per voxel holds the codes of two neighbors, so that four fetches give a whole trilinear cell:
///   word(x, y, z) = c(x, y, z) | c(x+1, y, z) << 8,  8 x 9 x 9 of them per brick; codes are those of voxel_block.h
/// A brick is not stored if all of its voxels have one code, or if it is invisible and none of its 26 neighbors is needed: rays skip it
/// according to the map. Gradients are read with linear interpolation from every second voxel, 5^3 per brick, or from every voxel, 9^3, if
/// those of neighbors are uncorrelated (noise). Local positions: local = index - origin, the origin a multiple of 8; the domain is box_lo
/// .. box_hi.
///   map, R32_UINT, a word per brick: bits 0..23 its slot (x, y, z, 8 bits each), or, if it is not stored, its code in bits 0..7;
///   bits 24..30 as in HomogeneousMap (brick_map.h), at most 127; bit 31: it is not stored
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "render/residency/resident_grid.h"
#include "render/residency/voxel_block.h"
#include "render/vk/resources.h"

namespace catena::render {

/// Properties of a grid's bricks, determined before any of them is packed.
struct BrickScan {
  field::Index3 origin, box_lo, box_hi;
  std::array<std::int32_t, 3> bricks{};  ///< bricks per axis
  std::vector<BrickRange> values;        ///< range of each brick's 9^3 voxels, x fastest
  ValueInterval range;                   ///< range of values to encode (widen_to_cells)
  bool with_gradients = false;           ///< gradients are requested
  /// Mean squared error of interpolation from every second voxel, relative to the mean square of the gradients.
  double gradient_roughness = 0;
};

/// Packed bricks on the device.
struct PackedAtlas {
  CodeScale codes;
  vk::Image words;      ///< R16_UINT
  vk::Image gradients;  ///< kGradientFormat; empty if not requested
  vk::Image map;
  std::uint32_t gradient_nodes = 0;  ///< gradient samples per brick and axis
  std::vector<std::uint32_t> slots;  ///< per brick, as in the map; kNotStored: not stored
  std::uint64_t stored_count = 0;
  std::uint64_t bytes() const { return words.bytes() + gradients.bytes(); }
  static constexpr std::uint32_t kNotStored = ~0u;
};

/// Returns whether the grid has few enough bricks and no invalid cells.
bool can_pack_as_bricks(const field::ScalarGrid& grid);

/// Scans the bricks for values in `active`.
BrickScan scan_bricks(const field::ScalarGrid& grid, const ValueInterval& active, bool gradients);

/// Returns the error of packing that needs more memory than permitted, bytes.
Error memory_limit_error(std::uint64_t needed, std::uint64_t limit);

/// Packs the bricks. An Error if that takes more than `max_bytes` of device memory.
Result<PackedAtlas> make_packed_atlas(vk::Device& device, const field::ScalarGrid& grid, const BrickScan& scan, const CodeScale& codes,
                                      const CodeAppearance& appearance, std::uint64_t max_bytes);

/// Rebuilds the map for another transfer function of the same codes. Returns false if that needs bricks that are not stored.
Result<bool> remap_atlas(vk::Device& device, PackedAtlas& atlas, const BrickScan& scan, const CodeAppearance& appearance);

}  // namespace catena::render
