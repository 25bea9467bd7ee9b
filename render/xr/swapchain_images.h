/// Images that the runtime lends, of one view or of a panel. Colours are 8 bits of sRGB: Catena's are display values, and are copied as
/// they are; an sRGB image says that its bytes are display values already, so nothing is encoded twice. Where a runtime has no sRGB format,
/// its plain one gets the same bytes. Depths are floats. Images come and go in the layout of an attachment. Frame thread.
#pragma once
#include <memory>
#include <vector>

#include "render/vk/commands.h"
#include "render/xr/session.h"

namespace catena::render::xr {

enum class SwapchainContent { color, depth };

class SwapchainImages {
 public:
  static Result<std::unique_ptr<SwapchainImages>> create(Session& session, ViewSize size,
                                                         SwapchainContent content = SwapchainContent::color);
  ~SwapchainImages();
  SwapchainImages(const SwapchainImages&) = delete;
  SwapchainImages& operator=(const SwapchainImages&) = delete;

  XrSwapchain handle() const { return swapchain_; }
  ViewSize size() const { return size_; }

  /// Copies a picture that is at most of this size (RGBA, 8 bits; of depths: D32) to the upper left of the next image, and hands that
  /// over. The next frame's layers show it.
  Outcome submit_image(vk::Image& picture);

 private:
  SwapchainImages(Session& session, ViewSize size, SwapchainContent content) : session_(&session), size_(size), content_(content) {}
  Outcome copy(vk::Image& picture, VkImage to);

  Session* session_;
  ViewSize size_;
  SwapchainContent content_;
  XrSwapchain swapchain_ = XR_NULL_HANDLE;
  std::vector<VkImage> images_;
};

}  // namespace catena::render::xr
