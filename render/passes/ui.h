// SPDX-License-Identifier: MIT
/// Window image: the finished image, scaled (linear filter) to the window or to UiItems::image_area, with the user interface over it in
/// window pixels.
///   shown.rgb = a rgb + (1 - a) below.rgb, a and rgb of the triangle: vertex color x texture, straight alpha, display values
/// A pixel is covered if its center lies inside the triangle and inside the draw's clip rectangle; draws are blended in order. The rendered
/// image itself is unchanged, so that the window can be repainted without rendering it. Not one of the packet's passes: the renderer paints
/// when a window is presented. Frame thread only. Buffers only grow and are reused. A texture is uploaded once per object and destroyed
/// when it has not been used for kTextureIdlePaints paints.
#pragma once
#include <map>
#include <memory>

#include "render/frame/overlay_items.h"
#include "render/vk/commands.h"

namespace catena::render {

/// Paints window images.
class WindowPainter {
 public:
  static constexpr std::uint64_t kTextureIdlePaints = 4;

  explicit WindowPainter(vk::Device& device) : device_(&device) {}

  /// Paints and waits until it is done. An Error for a window of 0 pixels or beyond the device's image size, if memory is short, or if the
  /// device is lost. Indices of the items must be in range.
  Outcome paint(vk::Image& rendered, std::uint32_t width, std::uint32_t height, const UiItems& items);
  /// Returns the image painted last, in the layout TRANSFER_SRC.
  vk::Image& window() { return window_; }

 private:
  struct Texture {
    vk::Image image;
    std::uint64_t last_used = 0;  ///< number of the last paint that used it
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
  /// Textures by object; the key keeps the object alive, so that its address is not reused.
  std::map<std::shared_ptr<const UiTexture>, Texture> textures_;
  std::shared_ptr<const UiTexture> white_;  ///< for draws without a texture
  std::uint64_t paint_count_ = 0;
};

}  // namespace catena::render
