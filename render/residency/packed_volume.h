// SPDX-License-Identifier: MIT
/// Scalar grid packed for the fast raycast: one 32-bit word per voxel with the codes of four neighbors, so that two fetches give a whole
/// trilinear cell.   word(x, y, z) = c(x, y, z) | c(x+1, y, z) << 8 | c(x, y+1, z) << 16 | c(x+1, y+1, z) << 24 Codes are those of
/// voxel_block.h; beyond the ends the end codes are held. Their range is the smallest one that includes every cell in which the transfer
/// function changes: `active`, widened by the corners of the cells that touch it. Ranges of the codes per brick of 4^3 cells are kept on
/// the host. Local positions: local = index - origin, the domain is 0 .. size - 1. Grids of many voxels, most of them invisible, are packed
/// as bricks instead (packed_atlas.h).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "render/residency/voxel_block.h"
#include "render/vk/resources.h"

namespace catena::render {

/// Cells per axis of a brick.
inline constexpr int kSmallBrickSize = 4;

/// Packed grid on the device and its code ranges.
struct PackedVolume {
  vk::Image words;  ///< R32_UINT
  field::Index3 origin, size;
  CodeScale codes;
  std::array<std::int32_t, 3> bricks{};  ///< bricks per axis
  std::vector<CodeRange> ranges;         ///< per brick, x fastest
};

/// Returns whether a grid can be packed densely on this device: at least one cell thick, of a size for which it is worthwhile, and without
/// a mask of cells, which codes by voxel cannot represent.
bool can_pack_dense(const vk::Device& device, const field::ScalarGrid& grid);

/// Returns the bytes of the packed words, including gradients (gradient_volume.h) if requested.
std::uint64_t packed_bytes(const field::ScalarGrid& grid, bool gradients);

/// Packs the grid. An Error if there is no memory.
Result<PackedVolume> make_packed_volume(vk::Device& device, const field::ScalarGrid& grid, const ValueInterval& active);

}  // namespace catena::render
