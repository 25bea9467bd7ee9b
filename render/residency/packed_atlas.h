/// A large scalar grid for fast raycasting: only what the transfer function asks for, as bricks of 8^3 cells in one image.
/// A word of 16 bits a voxel holds the codes of two neighbours, so that four fetches give a whole trilinear cell:
///   word(x, y, z) = c(x, y, z) | c(x+1, y, z) << 8,  8 x 9 x 9 of them a brick; codes are those of voxel_block.h
/// A brick is not kept where all of its voxels have one code, or where it is invisible and none of its 26 neighbours is needed: rays leap
/// over it by the map. Gradients are read with linear interpolation from every second voxel, 5^3 a brick, or from every one, 9^3, where
/// those of neighbours have little to do with each other (noise).
/// Local positions: local = index - origin, the origin a multiple of 8; the domain is box_lo .. box_hi.
///   map, R32_UINT, a word a brick: bits 0..23 its slot (x, y, z, 8 bits each), or, where it is not kept, its code in bits 0..7;
///   bits 24..30 as in HomogeneousMap (brick_map.h), at most 127; bit 31: it is not kept
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "render/residency/resident_grid.h"
#include "render/residency/voxel_block.h"
#include "render/vk/resources.h"

namespace catena::render {

/// What is found of a grid's bricks before any of them is packed.
struct BrickScan {
  field::Index3 origin, box_lo, box_hi;
  std::array<std::int32_t, 3> bricks{};  ///< an axis
  std::vector<BrickRange> values;        ///< x fastest, over 9^3 voxels
  ValueInterval range;                   ///< to encode (widen_to_cells)
  bool with_gradients = false;           ///< they are asked for
  double gradient_roughness = 0;         ///< what interpolation from every second voxel errs by, squares, in mean squares of gradients
};

struct PackedAtlas {
  CodeScale codes;
  vk::Image words;      ///< R16_UINT
  vk::Image gradients;  ///< kGradientFormat, where they were asked for
  vk::Image map;
  std::uint32_t gradient_nodes = 0;  ///< of a brick, an axis
  std::vector<std::uint32_t> slots;  ///< of the bricks, as in the map; kNotStored: it has none
  std::uint64_t stored_count = 0;
  std::uint64_t bytes() const { return words.bytes() + gradients.bytes(); }
  static constexpr std::uint32_t kNotStored = ~0u;
};

/// Whether a grid has bricks few enough to be packed so, and no invalid cells.
bool can_pack_as_bricks(const field::ScalarGrid& grid);

BrickScan scan_bricks(const field::ScalarGrid& grid, const ValueInterval& active, bool gradients);

/// What packing says where it takes too much of the device.
Error memory_limit_error(std::uint64_t needed, std::uint64_t most);

/// An error where it takes more than `max_bytes` of the device.
Result<PackedAtlas> make_packed_atlas(vk::Device& device, const field::ScalarGrid& grid, const BrickScan& scan, const CodeScale& codes,
                                      const CodeAppearance& looks, std::uint64_t most_bytes);

/// The map again for another transfer function of the same codes. False: it asks for bricks that are not kept.
Result<bool> remap_atlas(vk::Device& device, PackedAtlas& atlas, const BrickScan& scan, const CodeAppearance& looks);

}  // namespace catena::render
