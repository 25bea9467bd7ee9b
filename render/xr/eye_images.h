/// The images of one view that the runtime lends: 8 bits of sRGB, of the size that the headset recommends. Catena's colours are display
/// values, and are copied as they are: an sRGB image says that its bytes are display values already, so nothing is encoded twice. Where
/// a runtime has no sRGB format, its plain one gets the same bytes. Images come and go in the layout of a colour attachment.
/// Frame thread.
#pragma once
#include <memory>
#include <vector>

#include "render/vk/commands.h"
#include "render/xr/session.h"

namespace catena::render::xr {

class EyeImages {
 public:
  static Result<std::unique_ptr<EyeImages>> create(Session& session, ViewSize size);
  ~EyeImages();
  EyeImages(const EyeImages&) = delete;
  EyeImages& operator=(const EyeImages&) = delete;

  XrSwapchain handle() const { return swapchain_; }
  ViewSize size() const { return size_; }

  /// Copies a picture that is at most of this size (RGBA, 8 bits) to the upper left of the next image, and hands that over. The next
  /// frame's layers show it.
  Outcome take(vk::Image& picture);

 private:
  EyeImages(Session& session, ViewSize size) : session_(&session), size_(size) {}
  Outcome copy(vk::Image& picture, VkImage to);

  Session* session_;
  ViewSize size_;
  XrSwapchain swapchain_ = XR_NULL_HANDLE;
  std::vector<VkImage> images_;
};

}  // namespace catena::render::xr
