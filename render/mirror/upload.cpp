#include "render/mirror/upload.h"

#include <algorithm>

namespace catena::render {

Outcome upload_planes(vk::Device& device, vk::Image& image, std::uint32_t granule,
                      const std::function<void(std::uint32_t first, std::uint32_t count, std::byte* out)>& fill) {
  constexpr VkDeviceSize staging_limit = VkDeviceSize(32) << 20;
  const VkExtent3D extent = image.info().extent;
  const VkDeviceSize plane = vk::texel_bytes(image.info().format) * extent.width * extent.height;
  const auto granules = std::uint32_t(std::max<VkDeviceSize>(1, staging_limit / (plane * granule)));
  const std::uint32_t piece = std::min(extent.depth, granules * granule);
  CATENA_TRY(const vk::Buffer staging, vk::Buffer::create(device, plane * piece, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, vk::Memory::upload));
  for (std::uint32_t first = 0; first < extent.depth; first += piece) {
    const std::uint32_t count = std::min(piece, extent.depth - first);
    fill(first, count, staging.bytes().data());
    CATENA_TRY(vk::Commands commands, vk::Commands::begin(device));
    commands.use(image, vk::kTransferWrite);
    commands.copy(staging, 0, image, {0, 0, std::int32_t(first)}, {extent.width, extent.height, count});
    if (first + count == extent.depth) commands.use(image, vk::kFragmentRead);
    CATENA_CHECK(commands.finish());
  }
  return Done{};
}

}  // namespace catena::render
