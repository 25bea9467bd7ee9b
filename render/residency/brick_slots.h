// SPDX-License-Identifier: MIT
/// Layout of the bricks of an atlas in its image: slots of equal size, in a block as near to a cube as their number permits, so that its
/// longest side is minimal. Slots are numbered x fastest. Any thread.
#pragma once
#include <array>
#include <cstdint>

#include "engine/base/result.h"
#include "render/vk/device.h"

namespace catena::render {

/// Numbers of slots of an atlas image.
struct BrickSlots {
  std::array<std::uint32_t, 3> slots_per_axis{};
  /// Returns the slot's position as stored in maps and read by shaders: x | y << 8 | z << 16.
  std::uint32_t pack_slot(std::uint64_t slot) const;
};

/// Returns a layout for at least `count` bricks (at least one), each at most `texels` wide per axis. The Error's text is the end of a
/// message: "12 bricks, at most 8 fit".
Result<BrickSlots> assign_brick_slots(const vk::Device& device, std::uint64_t count, std::uint32_t texels);

}  // namespace catena::render
