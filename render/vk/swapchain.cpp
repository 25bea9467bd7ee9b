// SPDX-License-Identifier: MIT
#include "render/vk/swapchain.h"

#include <algorithm>
#include <limits>

#include "render/vk/commands.h"
#include "render/vk/instance.h"

namespace catena::render::vk {
namespace {

VkSemaphoreCreateInfo binary_semaphore() {
  VkSemaphoreCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
  return info;
}

/// Chooses a UNORM format in the sRGB color space, so that display values are presented unchanged.
Result<VkSurfaceFormatKHR> choose_format(const Device& device) {
  std::uint32_t count = 0;
  CATENA_VK(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical(), device.surface(), &count, nullptr), "list the window's formats");
  std::vector<VkSurfaceFormatKHR> formats(count);
  CATENA_VK(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical(), device.surface(), &count, formats.data()), "list the window's formats");
  for (const VkSurfaceFormatKHR& f : formats)
    if ((f.format == VK_FORMAT_B8G8R8A8_UNORM || f.format == VK_FORMAT_R8G8B8A8_UNORM) && f.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR)
      return f;
  return Error{"the window has no 8-bit UNORM format, expected B8G8R8A8_UNORM or R8G8B8A8_UNORM"};
}

}  // namespace

Result<std::unique_ptr<Swapchain>> Swapchain::create(Device& device, std::uint32_t width, std::uint32_t height) {
  if (!device.surface()) return Error{"the device was created without a window"};
  std::unique_ptr<Swapchain> self(new Swapchain(device));
  CATENA_TRY(self->format_, choose_format(device));
  CATENA_CHECK(self->resize(width, height));
  return self;
}

Swapchain::~Swapchain() { destroy(); }

void Swapchain::destroy() {
  {
    const auto turn = device_->lock_queue();
    (void)vkDeviceWaitIdle(device_->handle());
  }
  for (VkSemaphore s : render_finished_) vkDestroySemaphore(device_->handle(), s, nullptr);
  render_finished_.clear();
  images_.clear();
  if (image_acquired_) vkDestroySemaphore(device_->handle(), image_acquired_, nullptr);
  image_acquired_ = VK_NULL_HANDLE;
  if (swapchain_) vkDestroySwapchainKHR(device_->handle(), swapchain_, nullptr);
  swapchain_ = VK_NULL_HANDLE;
}

Outcome Swapchain::resize(std::uint32_t width, std::uint32_t height) {
  destroy();
  Outcome made = create_swapchain(width, height);
  if (!made) destroy();
  return made;
}

Outcome Swapchain::create_swapchain(std::uint32_t width, std::uint32_t height) {
  VkSurfaceCapabilitiesKHR caps{};
  CATENA_VK(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_->physical(), device_->surface(), &caps), "query the window's capabilities");
  extent_ = caps.currentExtent;
  if (extent_.width == std::numeric_limits<std::uint32_t>::max())
    extent_ = {std::clamp(width, caps.minImageExtent.width, caps.maxImageExtent.width),
               std::clamp(height, caps.minImageExtent.height, caps.maxImageExtent.height)};
  if (extent_.width == 0 || extent_.height == 0) return Done{};  // minimized: present() returns false until it is restored
  VkSwapchainCreateInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
  info.surface = device_->surface();
  info.minImageCount = std::max(2u, caps.minImageCount);
  if (caps.maxImageCount) info.minImageCount = std::min(info.minImageCount, caps.maxImageCount);
  info.imageFormat = format_.format;
  info.imageColorSpace = format_.colorSpace;
  info.imageExtent = extent_;
  info.imageArrayLayers = 1;
  info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  info.preTransform = caps.currentTransform;
  for (const VkCompositeAlphaFlagBitsKHR alpha : {VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR, VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR})
    if (caps.supportedCompositeAlpha & alpha) info.compositeAlpha = alpha;
  info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
  info.clipped = VK_TRUE;
  CATENA_VK(vkCreateSwapchainKHR(device_->handle(), &info, nullptr, &swapchain_), "create the window's images");
  std::uint32_t count = 0;
  CATENA_VK(vkGetSwapchainImagesKHR(device_->handle(), swapchain_, &count, nullptr), "list the window's images");
  images_.resize(count);
  CATENA_VK(vkGetSwapchainImagesKHR(device_->handle(), swapchain_, &count, images_.data()), "list the window's images");
  const VkSemaphoreCreateInfo semaphore = binary_semaphore();
  CATENA_VK(vkCreateSemaphore(device_->handle(), &semaphore, nullptr, &image_acquired_), "create a semaphore");
  render_finished_.resize(count);
  for (VkSemaphore& s : render_finished_) CATENA_VK(vkCreateSemaphore(device_->handle(), &semaphore, nullptr, &s), "create a semaphore");
  return Done{};
}

/// Returns whether the swapchain has the window's size. A suboptimal swapchain of this size is kept, because a new one would be the same.
bool Swapchain::has_window_size() const {
  VkSurfaceCapabilitiesKHR caps{};
  if (vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_->physical(), device_->surface(), &caps) != VK_SUCCESS) return false;
  return caps.currentExtent.width == std::numeric_limits<std::uint32_t>::max() ||
         (caps.currentExtent.width == extent_.width && caps.currentExtent.height == extent_.height);
}

Result<bool> Swapchain::present(const Image& source) {
  if (!swapchain_) return false;
  std::uint32_t index = 0;
  const VkResult acquired = vkAcquireNextImageKHR(device_->handle(), swapchain_, std::numeric_limits<std::uint64_t>::max(), image_acquired_,
                                                  VK_NULL_HANDLE, &index);
  if (acquired == VK_ERROR_OUT_OF_DATE_KHR) return false;
  if (acquired != VK_SUCCESS && acquired != VK_SUBOPTIMAL_KHR) return vulkan_error(acquired, "acquire an image of the window");
  Result<bool> shown = copy_and_present(source, index, acquired == VK_SUCCESS);
  if (!shown) destroy();  // an acquired image was not presented, and no submission waits for its semaphore
  return shown;
}

Result<bool> Swapchain::copy_and_present(const Image& source, std::uint32_t index, bool optimal) {
  // copies the image, scaled to the window
  CATENA_TRY(Commands commands, Commands::begin(*device_));
  const VkImage target = images_[index];
  const ResourceUse taken{VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_NONE};
  const ResourceUse presented{VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_NONE};
  commands.barrier(target, VK_IMAGE_ASPECT_COLOR_BIT, taken, kTransferWrite);
  commands.blit(source, target, extent_);
  commands.barrier(target, VK_IMAGE_ASPECT_COLOR_BIT, kTransferWrite, presented);
  CATENA_TRY(const std::uint64_t value, commands.submit(image_acquired_, render_finished_[index]));

  VkPresentInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
  info.waitSemaphoreCount = 1;
  info.pWaitSemaphores = &render_finished_[index];
  info.swapchainCount = 1;
  info.pSwapchains = &swapchain_;
  info.pImageIndices = &index;
  const VkResult shown = [&] {
    const auto turn = device_->lock_queue();
    return vkQueuePresentKHR(device_->queue(), &info);
  }();
  CATENA_CHECK(device_->wait(value));
  if (shown == VK_ERROR_OUT_OF_DATE_KHR) return false;
  if (shown != VK_SUCCESS && shown != VK_SUBOPTIMAL_KHR) return vulkan_error(shown, "present the image");
  return (optimal && shown == VK_SUCCESS) || has_window_size();
}

}  // namespace catena::render::vk
