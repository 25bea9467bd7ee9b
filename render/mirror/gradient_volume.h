/// Gradients for shading in the fast raycast: directions of central differences of one voxel at every voxel, R8G8B8A8_UNORM, read with
/// linear interpolation. Only directions count (a headlight): a vector is 128 + 127 g / (3 rms |g|), shortened to fit.
/// The shading of `reference`, for 4 bytes a voxel more; without it the gradient of the cell serves. Made when first asked for.
#pragma once
#include "engine/field/grid.h"
#include "render/vk/resources.h"

namespace catena::render {

/// `grid` can_be_packed.
Result<vk::Image> make_gradient_volume(vk::Device& device, const field::ScalarGrid& grid);

}  // namespace catena::render
