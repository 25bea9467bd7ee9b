#include "render/passes/targets.h"

#include "render/vk/commands.h"

namespace catena::render {
namespace {

Outcome fit(vk::Device& device, vk::Image& image, VkFormat format, std::uint32_t width, std::uint32_t height, VkImageUsageFlags usage) {
  const VkExtent3D& have = image.info().extent;
  if (image && have.width == width && have.height == height) return Done{};
  vk::ImageInfo info;
  info.format = format;
  info.extent = {width, height, 1};
  info.usage = usage;
  CATENA_TRY(image, vk::Image::create(device, info));
  return Done{};
}

}  // namespace

Outcome Targets::ensure(vk::Device& device, std::uint32_t width, std::uint32_t height, bool opaque, bool has_volume) {
  constexpr VkImageUsageFlags color = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  constexpr VkImageUsageFlags read = VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  CATENA_CHECK(
      fit(device, picture, kPictureFormat, width, height, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT | read));
  if (opaque) {
    CATENA_CHECK(fit(device, opaque_color, kOpaqueFormat, width, height, color | read));
    CATENA_CHECK(fit(device, opaque_depth, kDepthValueFormat, width, height, color | read));
    CATENA_CHECK(fit(device, depth_buffer, kDepthBufferFormat, width, height, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT));
  }
  if (has_volume) CATENA_CHECK(fit(device, volume, kVolumeFormat, width, height, color | VK_IMAGE_USAGE_STORAGE_BIT));
  if (!none) {
    CATENA_CHECK(fit(device, none, kPictureFormat, 1, 1, VK_IMAGE_USAGE_SAMPLED_BIT));
    CATENA_TRY(vk::Commands commands, vk::Commands::begin(device));
    commands.use(none, vk::kFragmentRead);
    CATENA_CHECK(commands.finish());
  }
  return Done{};
}

}  // namespace catena::render
