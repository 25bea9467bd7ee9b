/// Gradients for shading in the fast raycast: central differences of one voxel, R8G8B8A8_UNORM, read with linear interpolation:
///   128 + 127 g / (3 rms |g|), the mean over the voxels whose values are in `active`, for what is not seen needs no light
/// Longer ones are shortened, which the fourth component says (1): the light needs directions more than lengths. At the ends of the
/// grid, and beside voxels that no valid cell has, differences are one-sided.
/// The shading of `reference`, for 4 bytes a voxel more; without it the gradient of the cell serves. Made when first asked for.
#pragma once
#include <cstddef>

#include "render/mirror/voxel_block.h"
#include "render/vk/resources.h"

namespace catena::render {

struct GradientVolume {
  vk::Image image;
  double unit = 0;  ///< values a voxel in one count of 1 / 127
};

/// `grid` can_be_packed (packed_volume.h).
Result<GradientVolume> make_gradient_volume(vk::Device& device, const field::ScalarGrid& grid, const ValueInterval& active);

/// A gradient, values a voxel.
struct BlockGradient {
  float x = 0, y = 0, z = 0;
  float length() const;
};
/// By differences within the block, whose ends are those of the grid or lie beyond the voxel's neighbours.
BlockGradient gradient_in(const VoxelBlock& block, int x, int y, int z);

/// The mean of squared gradients, summed in an order that does not depend on threads.
struct GradientMean {
  double squares = 0, count = 0;
  void add(const VoxelBlock& block, const ValueInterval& active, int x, int y, int z);
  void add(const GradientMean& other);
  /// Of the longest gradient that is kept whole.
  float longest() const;
};

/// As texels: four bytes.
void write_gradient(const BlockGradient& gradient, float longest, std::byte* out);

}  // namespace catena::render
