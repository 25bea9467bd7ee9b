// SPDX-License-Identifier: MIT
/// Shows images in the window: owns renderer and swapchain. A lost device is recreated, once per image; a resized window gets a new
/// swapchain; nothing is shown while minimized. Frame thread.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/viewer/window/window.h"
#include "render/frame/overlay_items.h"
#include "render/passes/renderer.h"
#include "render/vk/swapchain.h"

namespace catena::app {

/// Owns the graphics device of the window.
class Presenter {
 public:
  struct Options {
    std::uint64_t memory_budget_bytes = 0;                             ///< GPU memory budget; 0: what the driver offers.
    std::function<VkResult(render::vk::DriverCall)> inject_failure{};  ///< For tests only.
    /// Called whenever a device is created; returns the provider of Vulkan. Empty: the presenter's own.
    std::function<render::vk::VulkanProvider()> vulkan_maker{};
    std::function<void()> before_device_created{};  ///< Called before a device is created; releases what depends on the last one.
  };

  /// Creates device, renderer and swapchain. An Error if that fails. `window` must outlive the presenter.
  static Result<std::unique_ptr<Presenter>> open(Window& window, Options options);

  /// Returns the size of the framebuffer in pixels; 0 while minimized.
  void size(std::uint32_t& width, std::uint32_t& height) const { window_.framebuffer_size(width, height); }
  /// Returns whether the window's size differs from that of the shown image.
  bool is_resized() const;

  /// Renders an image; if the device is lost, recreates it and renders again. An Error if that fails.
  Outcome draw(const render::FramePacket& packet, const render::RenderSettings& settings);
  /// Shows the last image with the GUI over it. If the device is lost, it is recreated and the image is gone: check has_image(). An Error
  /// after three losses in a row.
  Outcome show(const render::UiItems& ui);
  /// Returns what the image shows at a pixel; nothing if there is no image or the pixel is outside.
  std::optional<render::PickResult> pick(double x, double y);
  /// Marks that the renderer has rendered an image without draw().
  void mark_rendered() { has_image_ = true; }
  /// Recreates the device: because the provider has changed, or because the device was lost while rendering without draw().
  Outcome recreate();
  /// Returns whether there is an image to show.
  bool has_image() const { return has_image_; }
  /// Returns whether the window has shown an image.
  bool has_presented() const { return has_presented_; }
  /// Returns the window as shown, including the GUI.
  Result<render::Image8> capture_window();

  render::Renderer& renderer() { return *renderer_; }
  /// Returns how often the device was lost and recreated.
  int recovery_count() const { return recovery_count_; }

 private:
  Presenter(Window& window, Options options) : window_(window), options_(std::move(options)) {}
  Outcome create_device();
  Outcome recover();

  Window& window_;
  Options options_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<render::vk::Swapchain> swapchain_;
  bool size_matches_ = true;  ///< The swapchain has the window's size.
  bool has_image_ = false, has_presented_ = false;
  int recovery_count_ = 0, consecutive_losses_ = 0;  ///< Consecutive losses are counted in show().
};

}  // namespace catena::app
