/// Gradients for shading in the fast raycast: central differences of one voxel, in codes a voxel, as half floats (R16G16B16A16_SFLOAT, the
/// fourth is 0), read with linear interpolation. The light goes by directions alone, so that it asks for the gradients of plateaus, a
/// thousandth of those at edges, as exactly as for any other: no fixed-point number of 8 or 10 bits has both. What is longer than half
/// floats reach is shortened. At the ends of the grid, and beside voxels that no valid cell has, differences are one-sided.
/// The shading of `reference`, for 8 bytes a voxel more; without it the gradient of the cell serves. Made when first asked for.
#pragma once
#include <cstddef>

#include "render/residency/voxel_block.h"
#include "render/vk/resources.h"

namespace catena::render {

inline constexpr VkFormat kGradientFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr std::size_t kGradientBytes = 8;

/// `grid` can_pack_dense (packed_volume.h); `per_code`: values a code, 0 where it is constant.
Result<vk::Image> make_gradient_volume(vk::Device& device, const field::ScalarGrid& grid, double per_code);

/// A gradient, values a voxel.
struct BlockGradient {
  float x = 0, y = 0, z = 0;
  float length() const;
};
/// By differences within the block, whose ends are those of the grid or lie beyond the voxel's neighbours.
BlockGradient block_gradient(const VoxelBlock& block, int x, int y, int z);

/// As a texel; `per_code` as above.
void write_gradient(const BlockGradient& gradient, double per_code, std::byte* out);

}  // namespace catena::render
