/// Gradients for shading in the fast raycast: directions of central differences of one voxel at every voxel, R8G8B8A8_UNORM, read with
/// linear interpolation: 128 + 127 g / (3 rms |g|). Longer ones are shortened, which the fourth component says (1): the light needs
/// directions more than lengths.
/// The shading of `reference`, for 4 bytes a voxel more; without it the gradient of the cell serves. Made when first asked for.
#pragma once
#include "engine/field/grid.h"
#include "render/vk/resources.h"

namespace catena::render {

struct GradientVolume {
  vk::Image image;
  double unit = 0;  ///< values a voxel in one count of 1 / 127
};

/// `grid` can_be_packed.
Result<GradientVolume> make_gradient_volume(vk::Device& device, const field::ScalarGrid& grid);

}  // namespace catena::render
