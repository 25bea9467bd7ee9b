/// A window's images: UNORM, so that display values stay as they are. present() copies (and scales) a finished picture.
/// FIFO, with as few images as the window system takes: nothing is drawn that no one sees, and no more frames than needed wait between
/// the hand and the eye. Frame thread only.
#pragma once
#include <vulkan/vulkan.h>

#include <memory>
#include <vector>

#include "render/vk/device.h"
#include "render/vk/resources.h"

namespace catena::render::vk {

class Swapchain {
 public:
  /// For the surface that the device was created with; the size is used where the window system leaves it open.
  static Result<std::unique_ptr<Swapchain>> create(Device& device, std::uint32_t width, std::uint32_t height);
  ~Swapchain();
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  /// After a failure there are no images, and present() says false.
  Outcome resize(std::uint32_t width, std::uint32_t height);
  /// Copies `source` (in the layout TRANSFER_SRC) to the next image and shows it with the display's next refresh; waits until it is
  /// copied. False: out of date, or of another size than the window, call resize.
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
  std::vector<VkSemaphore> render_finished_;  ///< one an image
  VkSemaphore image_acquired_ = VK_NULL_HANDLE;
};

}  // namespace catena::render::vk
