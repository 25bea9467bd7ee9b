/// What rays are told and what they meet beside grids.
#pragma once
#include <memory>
#include <span>

#include "render/mirror/grid_mirror.h"
#include "render/vk/resources.h"

namespace catena::render {

inline constexpr VkFormat kVolumeFormat = VK_FORMAT_R32G32B32A32_SFLOAT;  ///< of what rays blend; premultiplied

struct RaySettings {
  double step_voxels = 1;
  double termination = 1.0 / 512;
  bool skip = true;
  bool jitter = false;
};

/// Something translucent that triangles drew, to be blended with what rays meet, in order: premultiplied colours, and the depth t
/// (shaders/shared/frame.h, R32_SFLOAT) of each; NO_DEPTH: nothing at this pixel. Of the picture's size.
struct Layer {
  vk::Image* color = nullptr;
  vk::Image* depth = nullptr;
};

/// What a picture's rays meet beside grids.
struct RayScene {
  const vk::Image* opaque_depth = nullptr;  ///< null: nothing opaque
  std::span<const Layer> layers{};
  const vk::Image* none = nullptr;  ///< bound where there is nothing
};

/// An item with the mirror of its grid, and of the grid that colours it, if there is one.
template <class Item>
struct Mirrored {
  const Item* item = nullptr;
  std::shared_ptr<const GridMirror> mirror, colors;
};

}  // namespace catena::render
