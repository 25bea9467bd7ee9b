/// A scalar grid for fast raycasting: one 32-bit word a voxel that holds the codes of four neighbours, so that two fetches give a
/// whole trilinear cell.   word(x, y, z) = c(x, y, z) | c(x+1, y, z) << 8 | c(x, y+1, z) << 16 | c(x+1, y+1, z) << 24
/// Codes are those of voxel_block.h; beyond the ends the end codes hold. Their range is the least one that keeps every cell whole in
/// which the transfer function changes: `active`, widened by the corners of the cells that touch it.
/// Codes' ranges are kept a brick of 4^3 cells, on the host. Local positions: local = index - origin, the domain is 0 .. size - 1.
/// Grids of many voxels, most of them of no interest, are packed as bricks instead (packed_atlas.h).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "render/residency/voxel_block.h"
#include "render/vk/resources.h"

namespace catena::render {

inline constexpr int kSmallBrickSize = 4;

struct PackedVolume {
  vk::Image words;  ///< R32_UINT
  field::Index3 origin, size;
  CodeScale codes;
  std::array<std::int32_t, 3> bricks{};  ///< an axis
  std::vector<CodeRange> ranges;         ///< x fastest
};

/// Whether a grid can be packed whole on this device: at least a cell thick, of a size that pays, and without a mask of cells, which codes
/// by voxel cannot hold.
bool can_pack_dense(const vk::Device& device, const field::ScalarGrid& grid);

/// Of its words, and of gradients (gradient_volume.h) where they are wanted.
std::uint64_t packed_bytes(const field::ScalarGrid& grid, bool gradients);

Result<PackedVolume> make_packed_volume(vk::Device& device, const field::ScalarGrid& grid, const ValueInterval& active);

}  // namespace catena::render
