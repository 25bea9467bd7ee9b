/// Images that the runtime lends, of one view or of a panel. Colours are 8 bits of sRGB: Catena's are display values, and are copied as
/// they are; an sRGB image says that its bytes are display values already, so nothing is encoded twice. Where a runtime has no sRGB format,
/// its plain one gets the same bytes. Depths are floats. Images come and go in the layout of an attachment. Frame thread.
#pragma once
#include <memory>
#include <vector>

#include "render/vk/commands.h"
#include "render/xr/session.h"

namespace catena::render::xr {

enum class Content { color, depth };

class EyeImages {
 public:
  static Result<std::unique_ptr<EyeImages>> create(Session& session, ViewSize size, Content content = Content::color);
  ~EyeImages();
  EyeImages(const EyeImages&) = delete;
  EyeImages& operator=(const EyeImages&) = delete;

  XrSwapchain handle() const { return swapchain_; }
  ViewSize size() const { return size_; }

  /// Copies a picture that is at most of this size (RGBA, 8 bits; of depths: D32) to the upper left of the next image, and hands that
  /// over. The next frame's layers show it.
  Outcome take(vk::Image& picture);

 private:
  EyeImages(Session& session, ViewSize size, Content content) : session_(&session), size_(size), content_(content) {}
  Outcome copy(vk::Image& picture, VkImage to);

  Session* session_;
  ViewSize size_;
  Content content_;
  XrSwapchain swapchain_ = XR_NULL_HANDLE;
  std::vector<VkImage> images_;
};

}  // namespace catena::render::xr
