/// A window's image: the finished picture, scaled to the window or the items' area of it (linear), with the user interface over it at the
/// window's own pixels.
///   shown.rgb = a rgb + (1 - a) below.rgb, a and rgb of the triangle: vertex colour x texture, straight alpha, display values
/// A pixel is drawn where its centre lies within the triangle and within the draw's clip rectangle; draws are blended in order. The
/// picture itself stays as it is, so that the next paint needs no new one. Not one of the packet's passes: the renderer paints with it
/// when a window is presented. Frame thread only.
/// Buffers grow to what they once held and are used again. A texture is uploaded once an object and goes when kTextureIdlePaints paints
/// have done without it.
#pragma once
#include <map>
#include <memory>

#include "render/frame/overlay_items.h"
#include "render/vk/commands.h"

namespace catena::render {

class WindowPainter {
 public:
  static constexpr std::uint64_t kTextureIdlePaints = 4;

  explicit WindowPainter(vk::Device& device) : device_(&device) {}

  /// Paints and waits until it is done. Errors: a window of 0 pixels or beyond the device's images, memory, a lost device. Items whose
  /// indices lead outside are a bug.
  Outcome paint(vk::Image& picture, std::uint32_t width, std::uint32_t height, const UiItems& items);
  /// What was painted last, in the layout TRANSFER_SRC.
  vk::Image& window() { return window_; }
  /// That are on the device now.

 private:
  struct Texture {
    vk::Image image;
    std::uint64_t last_used = 0;  ///< by this paint at last
  };
  Outcome ensure_window(std::uint32_t width, std::uint32_t height);
  Outcome upload(const UiItems& items);
  Outcome retain_texture(const std::shared_ptr<const UiTexture>& texture);
  void record(vk::Commands& commands, const UiItems& items);

  vk::Device* device_;
  vk::Pipeline pipeline_;
  vk::Sampler linear_;
  vk::Image window_;
  vk::Buffer uniform_, vertices_, indices_;
  /// By object, which is kept as long, so that its address is not another's.
  std::map<std::shared_ptr<const UiTexture>, Texture> textures_;
  std::shared_ptr<const UiTexture> white_;  ///< for draws without a texture
  std::uint64_t paint_count_ = 0;
};

}  // namespace catena::render
