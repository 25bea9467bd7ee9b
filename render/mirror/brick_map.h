/// What a ray asks before it samples: one word a brick of 8^3 cells, in an image R32_UINT.
///   bits 0..23: the brick's slot in the atlas (x, y, z, 8 bits each); bits 24..31: 0 if the brick is active, else the distance
///   (largest coordinate difference, in bricks, at most 255) to the nearest active one: all nearer bricks are inactive too.
/// Rebuilt when the transfer function or the level changes; the values stay where they are.
#pragma once
#include <functional>

#include "render/mirror/brick_distances.h"
#include "render/mirror/grid_mirror.h"

namespace catena::render {

struct BrickMap {
  vk::Image image;
  std::uint64_t active = 0, total = 0;
};

/// `is_active` is asked once for each brick that has a valid cell.
Result<BrickMap> make_brick_map(vk::Device& device, const GridMirror& mirror, const std::function<bool(const BrickRange&)>& is_active);

}  // namespace catena::render
