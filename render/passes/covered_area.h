/// Where in the picture something can be seen.
#pragma once
#include <vulkan/vulkan.h>

#include <span>

#include "render/frame/camera.h"

namespace catena::field {
class ScalarGrid;
}

namespace catena::render {

/// The pixels that the box around world points (its corners) can cover; the whole picture when one of them is behind the eye. No
/// points: none.
VkRect2D covered_area(std::span<const Vec3> points, const Camera& camera);

/// The pixels that the grids' domains can cover; the whole picture when a corner is behind the eye.
VkRect2D covered_area(std::span<const field::ScalarGrid* const> grids, const Camera& camera);

}  // namespace catena::render
