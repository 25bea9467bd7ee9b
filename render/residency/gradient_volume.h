// SPDX-License-Identifier: MIT
/// Gradients for shading in the fast raycast: central differences over one voxel, in codes per voxel, as half floats (R16G16B16A16_SFLOAT,
/// fourth component 0), read with linear interpolation. Shading depends on directions only, so that the gradients of plateaus, a thousandth
/// of those at edges, must be as exact as any other: fixed-point numbers of 8 or 10 bits cannot represent both. Gradients beyond the range
/// of half floats are shortened. At the ends of the grid, and next to voxels without a valid cell, differences are one-sided. This is the
/// shading of the reference settings, for 8 more bytes per voxel; without it the gradient of the cell is used. Built on first use.
#pragma once
#include <cstddef>

#include "render/residency/voxel_block.h"
#include "render/vk/resources.h"

namespace catena::render {

inline constexpr VkFormat kGradientFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr std::size_t kGradientBytes = 8;

/// Builds the gradients of a grid for which can_pack_dense() (packed_volume.h) is true. `per_code`: value difference per code, 0 for a
/// constant grid.
Result<vk::Image> make_gradient_volume(vk::Device& device, const field::ScalarGrid& grid, double per_code);

/// Gradient, in values per voxel.
struct BlockGradient {
  float x = 0, y = 0, z = 0;
  float length() const;
};
/// Returns the gradient by differences within the block, whose ends must be those of the grid or lie beyond the voxel's neighbors.
BlockGradient block_gradient(const VoxelBlock& block, int x, int y, int z);

/// Encodes a gradient as a texel; `per_code` as above.
void write_gradient(const BlockGradient& gradient, double per_code, std::byte* out);

}  // namespace catena::render
