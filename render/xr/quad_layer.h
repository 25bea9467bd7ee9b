// SPDX-License-Identifier: MIT
/// Flat panel in the local space: an image on a rectangle, on top of the scene. Composited by the runtime, sharp at any distance. Frame
/// thread.
#pragma once
#include "engine/base/vec.h"
#include "render/xr/actions.h"
#include "render/xr/swapchain_images.h"

namespace catena::render::xr {

/// Placement of the panel.
struct Quad {
  XrPose pose;                            ///< pose of its center in the local space, meters; it faces along +z
  double width_m = 0.5, height_m = 0.35;  ///< meters, > 0
  bool opaque = false;                    ///< the image's alpha is ignored
};

/// Panel with its swapchain.
class QuadLayer {
 public:
  /// Creates a panel of `size` pixels. An Error if the runtime refuses.
  static Result<std::unique_ptr<QuadLayer>> create(Session& session, ViewSize size);
  /// Sets the image (RGBA, 8 bits, straight alpha, of the layer's size).
  Outcome submit_image(vk::Image& image);
  void set_quad(const Quad& quad) { quad_ = quad; }
  /// Returns the layer for end_frame(), valid until the next call; null before the first image.
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
