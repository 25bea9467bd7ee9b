/// Presenter brings pictures into the window by its renderer and its swapchain. A device that is lost is made again, once for every lost
/// picture; a window that changes its size gets a new swapchain; a minimised one is not drawn to. Frame thread.
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

class Presenter {
 public:
  struct Options {
    std::uint64_t memory_budget_bytes = 0;                             ///< of the GPU; 0: what the driver offers
    std::function<VkResult(render::vk::DriverCall)> inject_failure{};  ///< tests only
    std::function<render::vk::VulkanProvider()> vulkan_maker{};  ///< of the device, asked whenever one is made; empty: the screen itself
    std::function<void()> before_device_created{};               ///< what hangs on the last device goes now
  };

  static Result<std::unique_ptr<Presenter>> open(Window& window, Options options);

  /// Pixels of the window now; 0 while minimised.
  void size(std::uint32_t& width, std::uint32_t& height) const { window_.framebuffer_size(width, height); }
  /// The window has another size than what is shown.
  bool is_resized() const;

  Outcome draw(const render::FramePacket& packet, const render::RenderSettings& settings);
  /// The last picture with the user interface over it. Where the device is lost on the way it is made again, and the picture is gone:
  /// has_image() says so.
  Outcome show(const render::UiItems& ui);
  /// What the picture shows at a pixel; nothing while there is no picture, or beyond it.
  std::optional<render::PickResult> pick(double x, double y);
  /// The renderer has drawn a picture without draw().
  void mark_rendered() { has_image_ = true; }
  /// Another device: of another maker, or for one that was lost on the way of who draws without draw().
  Outcome recreate();
  /// There is a picture to show.
  bool has_image() const { return has_image_; }
  /// There is a window's picture: what was shown last.
  bool has_presented() const { return has_presented_; }
  /// The window as it is shown, user interface and all.
  Result<render::Image8> capture_window();

  render::Renderer& renderer() { return *renderer_; }
  /// Times that the device was lost and made again.
  int recovery_count() const { return recovery_count_; }

 private:
  Presenter(Window& window, Options options) : window_(window), options_(std::move(options)) {}
  Outcome create_device();
  Outcome recover();

  Window& window_;
  Options options_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<render::vk::Swapchain> swapchain_;
  bool size_matches_ = true;  ///< the swapchain still has the window's size
  bool has_image_ = false, has_presented_ = false;
  int recovery_count_ = 0, consecutive_losses_ = 0;  ///< consecutive_losses_: while showing, in a row
};

}  // namespace catena::app
