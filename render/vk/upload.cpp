#include "render/vk/upload.h"

#include <algorithm>
#include <cstring>

namespace catena::render::vk {

Outcome upload_planes(Device& device, Image& image, std::uint32_t granule,
                      const std::function<void(std::uint32_t first, std::uint32_t count, std::byte* out)>& fill) {
  // staging memory counts in the budget: little is taken of little
  const VkDeviceSize staging_limit = std::min<VkDeviceSize>(VkDeviceSize(32) << 20, device.memory_left() / 4);
  const VkExtent3D extent = image.info().extent;
  const VkDeviceSize plane = texel_bytes(image.info().format) * extent.width * extent.height;
  const auto granules = std::uint32_t(std::max<VkDeviceSize>(1, staging_limit / (plane * granule)));
  const std::uint32_t piece = std::min(extent.depth, granules * granule);
  CATENA_TRY(const Buffer staging, Buffer::create(device, plane * piece, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, Memory::upload));
  for (std::uint32_t first = 0; first < extent.depth; first += piece) {
    const std::uint32_t count = std::min(piece, extent.depth - first);
    fill(first, count, staging.bytes().data());
    CATENA_TRY(Commands commands, Commands::begin(device));
    commands.use(image, kTransferWrite);
    commands.copy(staging, 0, image, {0, 0, std::int32_t(first)}, {extent.width, extent.height, count});
    if (first + count == extent.depth) commands.use(image, kFragmentRead);
    CATENA_CHECK(commands.finish());
  }
  return Done{};
}

Result<Buffer> upload_buffer(Device& device, std::span<const std::byte> bytes, VkBufferUsageFlags usage) {
  CATENA_TRY(const Buffer staging, Buffer::create(device, bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, Memory::upload));
  std::memcpy(staging.bytes().data(), bytes.data(), bytes.size());
  CATENA_TRY(Buffer buffer, Buffer::create(device, bytes.size(), usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::device));
  CATENA_TRY(Commands commands, Commands::begin(device));
  commands.copy(staging, buffer, bytes.size());
  commands.barrier(buffer, kTransferWrite, {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT});
  CATENA_CHECK(commands.finish());
  return buffer;
}

}  // namespace catena::render::vk
