/// Bytes to the device: through staging memory what changes seldom (these uploads wait for their own end), mapped what changes each frame.
#pragma once
#include <cstring>
#include <functional>

#include "render/vk/commands.h"

namespace catena::render::vk {

/// Fills `image` in pieces of whole z-ranges: fill(first_z, count_z, bytes) writes the texels x fastest. `granule` z-planes stay
/// together. Ends with the image ready for shaders.
Outcome upload_planes(Device& device, Image& image, std::uint32_t granule,
                      const std::function<void(std::uint32_t first, std::uint32_t count, std::byte* out)>& fill);

/// A device buffer with these bytes (at least one).
Result<Buffer> upload_buffer(Device& device, std::span<const std::byte> bytes, VkBufferUsageFlags usage);

/// A uniform buffer that the host writes each frame.
template <class Data>
Outcome write_uniform(Device& device, Buffer& buffer, const Data& data) {
  if (!buffer) {
    CATENA_TRY(buffer, Buffer::create(device, sizeof(Data), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, Memory::upload));
  }
  std::memcpy(buffer.bytes().data(), &data, sizeof(Data));
  return Done{};
}

}  // namespace catena::render::vk
