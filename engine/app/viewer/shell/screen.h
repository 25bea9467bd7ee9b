/// Screen brings pictures into the window by its renderer and its swapchain. A device that is lost is made again, once for every lost
/// picture; a window that changes its size gets a new swapchain; a minimised one is not drawn to. Frame thread.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/viewer/shell/window.h"
#include "render/frame/overlay_items.h"
#include "render/passes/renderer.h"
#include "render/vk/swapchain.h"

namespace catena::app {

class Screen {
 public:
  struct Options {
    std::uint64_t memory_budget_bytes = 0;                   ///< of the GPU; 0: what the driver offers
    std::function<VkResult(render::vk::DriverCall)> fail{};  ///< tests only
    std::function<render::vk::VulkanMaker()> maker{};        ///< of the device, asked whenever one is made; empty: the screen itself
    std::function<void()> before_making{};                   ///< what hangs on the last device goes now
  };

  static Result<std::unique_ptr<Screen>> open(Window& window, Options options);

  /// Pixels of the window now; 0 while minimised.
  void size(std::uint32_t& width, std::uint32_t& height) const { window_.framebuffer_size(width, height); }
  /// The window has another size than what is shown.
  bool is_resized() const;

  Outcome draw(const render::FramePacket& packet, const render::RenderSettings& settings);
  /// The last picture with the user interface over it. Where the device is lost on the way it is made again, and the picture is gone:
  /// has_picture() says so.
  Outcome show(const render::UiItems& ui);
  /// What the picture shows at a pixel; nothing while there is no picture, or beyond it.
  std::optional<render::Picked> pick(double x, double y);
  /// The renderer has drawn a picture without draw().
  void has_drawn() { has_picture_ = true; }
  /// Another device: of another maker, or for one that was lost on the way of who draws without draw().
  Outcome make_again();
  /// There is a picture to show.
  bool has_picture() const { return has_picture_; }
  /// There is a window's picture: what was shown last.
  bool is_shown() const { return is_shown_; }
  /// The window as it is shown, user interface and all.
  Result<render::Picture> window_picture();

  render::Renderer& renderer() { return *renderer_; }
  /// Times that the device was lost and made again.
  int recoveries() const { return recoveries_; }

 private:
  Screen(Window& window, Options options) : window_(window), options_(std::move(options)) {}
  Outcome make();
  Outcome recover();

  Window& window_;
  Options options_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<render::vk::Swapchain> swapchain_;
  bool fits_ = true;  ///< the swapchain still has the window's size
  bool has_picture_ = false, is_shown_ = false;
  int recoveries_ = 0, losses_ = 0;  ///< losses_: while showing, in a row
};

}  // namespace catena::app
