/// A flat panel in the room: a picture on a rectangle, over the scene. The runtime draws it, sharp at any distance. Frame thread.
#pragma once
#include "engine/base/vec.h"
#include "render/xr/actions.h"
#include "render/xr/swapchain_images.h"

namespace catena::render::xr {

struct Quad {
  XrPose pose;                            ///< of its middle; it faces along +z
  double width_m = 0.5, height_m = 0.35;  ///< > 0
  bool opaque = false;                    ///< the picture's alpha does not count
};

class QuadLayer {
 public:
  /// Of that many pixels.
  static Result<std::unique_ptr<QuadLayer>> create(Session& session, ViewSize size);
  /// The picture from now on (RGBA, 8 bits, straight alpha, of the layer's size).
  Outcome submit_image(vk::Image& picture);
  void set_quad(const Quad& quad) { quad_ = quad; }
  /// For end_frame; lives until the next call. Nothing before the first picture.
  const XrCompositionLayerBaseHeader* composition_layer();

 private:
  explicit QuadLayer(Session& session) : session_(&session) {}
  Session* session_;
  std::unique_ptr<SwapchainImages> images_;
  Quad quad_;
  ViewSize image_size_;
  XrCompositionLayerQuad layer_{};
};

}  // namespace catena::render::xr
