/// Where the bricks of an atlas lie in its image: slots of equal size, as near to a cube as their number allows, so that no side is longer
/// than it must be. Slots count x fastest. Any thread.
#pragma once
#include <array>
#include <cstdint>

#include "engine/base/result.h"
#include "render/vk/device.h"

namespace catena::render {

struct BrickSlots {
  std::array<std::uint32_t, 3> slots_per_axis{};
  /// A slot's place as maps and shaders have it: x | y << 8 | z << 16.
  std::uint32_t pack_slot(std::uint64_t slot) const;
};

/// Room for `count` bricks, one at least, of at most `texels` an axis each. The error ends a sentence: "12 bricks, at most 8 fit".
Result<BrickSlots> assign_brick_slots(const vk::Device& device, std::uint64_t count, std::uint32_t texels);

}  // namespace catena::render
