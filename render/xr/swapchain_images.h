// SPDX-License-Identifier: MIT
/// Images owned by the runtime, for one view or a panel. Colors are 8-bit sRGB: Catena's display values are copied unchanged; as an sRGB
/// image is defined to hold display values, nothing is encoded twice. If a runtime has no sRGB format, its plain format gets the same
/// bytes. Depths are floats. Images are acquired and released in the layout of an attachment. Frame thread.
#pragma once
#include <memory>
#include <vector>

#include "render/vk/commands.h"
#include "render/xr/session.h"

namespace catena::render::xr {

/// Content of a swapchain.
enum class SwapchainContent { color, depth };

/// Swapchain of the runtime.
class SwapchainImages {
 public:
  /// Creates a swapchain of `size` pixels. An Error if the runtime has no suitable format.
  static Result<std::unique_ptr<SwapchainImages>> create(Session& session, ViewSize size,
                                                         SwapchainContent content = SwapchainContent::color);
  ~SwapchainImages();
  SwapchainImages(const SwapchainImages&) = delete;
  SwapchainImages& operator=(const SwapchainImages&) = delete;

  XrSwapchain handle() const { return swapchain_; }
  ViewSize size() const { return size_; }

  /// Copies an image of at most this size (RGBA, 8 bits; for depth: D32) to the upper left part of the next swapchain image, and releases
  /// that to the runtime. The next frame's layers show it.
  Outcome submit_image(vk::Image& source);

 private:
  SwapchainImages(Session& session, ViewSize size, SwapchainContent content) : session_(&session), size_(size), content_(content) {}
  Outcome copy(vk::Image& source, VkImage to);

  Session* session_;
  ViewSize size_;
  SwapchainContent content_;
  XrSwapchain swapchain_ = XR_NULL_HANDLE;
  std::vector<VkImage> images_;
};

}  // namespace catena::render::xr
