// SPDX-License-Identifier: MIT
/// Swapchain of a window: UNORM images, so that display values are passed through unchanged. present() copies (and scales) a finished
/// image. FIFO mode with the minimum number of images: no frames are rendered that are never shown, and the latency between input and
/// display is minimal. Frame thread only.
#pragma once
#include <vulkan/vulkan.h>

#include <memory>
#include <vector>

#include "render/vk/device.h"
#include "render/vk/resources.h"

namespace catena::render::vk {

/// Swapchain for the surface of a device.
class Swapchain {
 public:
  /// Creates the swapchain for the surface that the device was created with; the size is used if the window system does not define one.
  static Result<std::unique_ptr<Swapchain>> create(Device& device, std::uint32_t width, std::uint32_t height);
  ~Swapchain();
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  /// Re-creates the images for a new size. After a failure there are no images, and present() returns false.
  Outcome resize(std::uint32_t width, std::uint32_t height);
  /// Copies `source` (in the layout TRANSFER_SRC) to the next image and presents it at the display's next refresh; waits until it is
  /// copied. Returns false if the swapchain is out of date or differs in size from the window: call resize().
  Result<bool> present(const Image& source);
  VkExtent2D extent() const { return extent_; }

 private:
  explicit Swapchain(Device& device) : device_(&device) {}
  void destroy();
  Outcome create_swapchain(std::uint32_t width, std::uint32_t height);
  Result<bool> copy_and_present(const Image& source, std::uint32_t index, bool optimal);
  bool has_window_size() const;

  Device* device_;
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  VkSurfaceFormatKHR format_{};
  VkExtent2D extent_{};
  std::vector<VkImage> images_;
  std::vector<VkSemaphore> render_finished_;  ///< one per image
  VkSemaphore image_acquired_ = VK_NULL_HANDLE;
};

}  // namespace catena::render::vk
