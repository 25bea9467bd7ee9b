/// Where a ray may leap: one byte a brick of 4^3 cells, in an image R8_UINT. 0: the transfer function varies in the brick. d > 0: the
/// brick is plain (empty, or of one colour and density), and so, alike, are all bricks nearer than d (largest coordinate
/// difference): a segment within that cube is integrated at once. Rebuilt when the transfer function changes.
#pragma once
#include <cstdint>
#include <span>

#include "render/mirror/brick_distances.h"
#include "render/mirror/packed_volume.h"

namespace catena::render {

struct PlainMap {
  vk::Image image;
  double leaping = 0;  ///< share of bricks with d > 0
};

/// `look[c]`: codes c and c + 1 (and all between) look alike if look[c] == look[c + 1]; a code where the look varies within half a
/// code of it has a number of its own.
Result<PlainMap> make_plain_map(vk::Device& device, const PackedVolume& packed, std::span<const std::uint16_t, 256> look);

}  // namespace catena::render
