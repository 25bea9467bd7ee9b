// SPDX-License-Identifier: MIT
#include "render/xr/swapchain_images.h"

#include <algorithm>
#include <array>

namespace catena::render::xr {

Result<std::unique_ptr<SwapchainImages>> SwapchainImages::create(Session& session, ViewSize size, SwapchainContent content) {
  Instance& instance = session.instance();
  const DispatchTable& xr = session.dispatch();
  std::uint32_t count = 0;
  CATENA_XR_CHECK(instance, xr.EnumerateSwapchainFormats(session.handle(), 0, &count, nullptr), "list its swapchain formats");
  std::vector<std::int64_t> formats(count);
  CATENA_XR_CHECK(instance, xr.EnumerateSwapchainFormats(session.handle(), count, &count, formats.data()), "list its swapchain formats");
  const bool depth = content == SwapchainContent::depth;
  const std::array<std::int64_t, 2> preferred = depth ? std::array<std::int64_t, 2>{VK_FORMAT_D32_SFLOAT, VK_FORMAT_D32_SFLOAT}
                                                      : std::array<std::int64_t, 2>{VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R8G8B8A8_UNORM};
  const auto format = std::ranges::find_if(preferred, [&](std::int64_t f) { return std::ranges::find(formats, f) != formats.end(); });
  if (format == preferred.end())
    return Error{"the headset " + instance.name() + " supports no " +
                 (depth ? "32-bit depth images, expected D32_SFLOAT" : "images with 8 bits per channel, expected R8G8B8A8_SRGB")};

  std::unique_ptr<SwapchainImages> self(new SwapchainImages(session, size, content));
  XrSwapchainCreateInfo info{};
  info.type = XR_TYPE_SWAPCHAIN_CREATE_INFO;
  info.usageFlags = XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT | XR_SWAPCHAIN_USAGE_SAMPLED_BIT;
  info.usageFlags |= depth ? XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT;
  info.format = *format;
  info.sampleCount = info.faceCount = info.arraySize = info.mipCount = 1;
  info.width = size.width;
  info.height = size.height;
  {
    const auto turn = session.device().lock_queue();
    CATENA_XR_CHECK(instance, xr.CreateSwapchain(session.handle(), &info, &self->swapchain_), "create images");
  }
  CATENA_XR_CHECK(instance, xr.EnumerateSwapchainImages(self->swapchain_, 0, &count, nullptr), "list its images");
  XrSwapchainImageVulkan2KHR source{};
  source.type = XR_TYPE_SWAPCHAIN_IMAGE_VULKAN2_KHR;
  std::vector<XrSwapchainImageVulkan2KHR> images(count, source);
  CATENA_XR_CHECK(
      instance, xr.EnumerateSwapchainImages(self->swapchain_, count, &count, reinterpret_cast<XrSwapchainImageBaseHeader*>(images.data())),
      "list its images");
  for (const XrSwapchainImageVulkan2KHR& one : images) self->images_.push_back(one.image);
  return self;
}

SwapchainImages::~SwapchainImages() {
  if (!swapchain_) return;
  (void)session_->device().wait_idle();
  const auto turn = session_->device().lock_queue();
  (void)session_->dispatch().DestroySwapchain(swapchain_);
}

Outcome SwapchainImages::submit_image(vk::Image& source) {
  Instance& instance = session_->instance();
  const DispatchTable& xr = session_->dispatch();
  std::uint32_t index = 0;
  {
    const auto turn = session_->device().lock_queue();
    CATENA_XR_CHECK(instance, xr.AcquireSwapchainImage(swapchain_, nullptr, &index), "acquire an image");
  }
  XrSwapchainImageWaitInfo wait{};
  wait.type = XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO;
  wait.timeout = XR_INFINITE_DURATION;
  CATENA_XR_CHECK(instance, xr.WaitSwapchainImage(swapchain_, &wait), "acquire an image");
  if (index >= images_.size()) return instance.failed(XR_ERROR_RUNTIME_FAILURE, "acquire an existing image");
  const Outcome copied = copy(source, images_[index]);
  const auto turn = session_->device().lock_queue();
  CATENA_XR_CHECK(instance, xr.ReleaseSwapchainImage(swapchain_, nullptr), "release an image");
  return copied;
}

Outcome SwapchainImages::copy(vk::Image& source, VkImage to) {
  const VkExtent3D extent = source.info().extent;
  CATENA_ASSERT(extent.width <= size_.width && extent.height <= size_.height);
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(session_->device()));
  commands.transition(source, vk::kTransferRead);
  vk::ResourceUse lent = content_ == SwapchainContent::depth ? vk::kDepthTarget : vk::kColorTarget;
  if (content_ == SwapchainContent::depth) lent.layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
  vk::ResourceUse before = lent;  // the runtime's use has ended, and the previous content is discarded
  before.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  commands.barrier(to, source.aspect(), before, vk::kTransferWrite);
  VkImageCopy region{};
  region.srcSubresource = region.dstSubresource = {source.aspect(), 0, 0, 1};
  region.extent = extent;
  vkCmdCopyImage(commands.handle(), source.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                 &region);
  commands.barrier(to, source.aspect(), vk::kTransferWrite, lent);
  CATENA_TRY([[maybe_unused]] const std::uint64_t done, commands.submit());
  return Done{};
}

}  // namespace catena::render::xr
