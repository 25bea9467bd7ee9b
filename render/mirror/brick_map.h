/// What a ray asks before it samples: one word a brick of 8^3 cells, in an image R32_UINT.
///   bits 0..23: the brick's slot in the atlas (x, y, z, 8 bits each); bits 24..31: 0 if the brick is active, else the distance
///   (largest coordinate difference, in bricks, at most 255) to the nearest active one: all nearer bricks are inactive too.
/// Volumes have their bits 24..31 otherwise: bits 24..30 the distance (at most 127) to the nearest brick of another kind, 0 if the
/// brick varies; bit 31: it is not empty but plain, of one colour and density.
/// Rebuilt when the transfer function or the level changes; the values stay where they are.
#pragma once
#include <functional>
#include <span>

#include "render/mirror/brick_distances.h"
#include "render/mirror/grid_mirror.h"

namespace catena::render {

struct BrickMap {
  vk::Image image;
  std::uint64_t active = 0, total = 0;
};

/// `is_active` is asked once for each brick that has a valid cell.
Result<BrickMap> make_brick_map(vk::Device& device, const GridMirror& mirror, const std::function<bool(const BrickRange&)>& is_active);

/// `kind` of each brick that has a valid cell: 0 varies, 1 empty, other numbers plain, equal where they look the same. Bricks that are
/// not wholly valid count as varying where they would be plain: with a mask, all of them.
Result<BrickMap> make_leap_map(vk::Device& device, const GridMirror& mirror, const std::function<std::uint16_t(const BrickRange&)>& kind);
/// Bits 24..31 as they are given, by brick.
Result<BrickMap> make_word_map(vk::Device& device, const GridMirror& mirror, std::span<const std::uint8_t> high);

}  // namespace catena::render
