/// Uploads through staging memory. They wait for their own end: what is uploaded changes seldom.
#pragma once
#include <functional>

#include "render/vk/commands.h"

namespace catena::render::vk {

/// Fills `image` in pieces of whole z-ranges: fill(first_z, count_z, bytes) writes the texels x fastest. `granule` z-planes stay
/// together. Ends with the image ready for shaders.
Outcome upload_planes(Device& device, Image& image, std::uint32_t granule,
                      const std::function<void(std::uint32_t first, std::uint32_t count, std::byte* out)>& fill);

/// A device buffer with these bytes (at least one).
Result<Buffer> upload_buffer(Device& device, std::span<const std::byte> bytes, VkBufferUsageFlags usage);

}  // namespace catena::render::vk
