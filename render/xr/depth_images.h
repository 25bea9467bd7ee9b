/// The depth of a view's picture, for the runtime to move it with the head between frames (XR_KHR_composition_layer_depth): of what is
/// opaque, and of volumes and what is translucent where alpha passes 0.5 on the way to that (of every kRaySpacing-th pixel's ray):
///   d = f / (f - n) (1 - n / z),  z metres from the eye along its axis, n = kNearM and f = kFarM; 1 where nothing is
/// A projection (maximum, minimum, average) has no depth: what is opaque behind it would lie too deep, and nothing is submitted. Frame
/// thread.
#pragma once
#include <array>
#include <memory>

#include "render/passes/renderer.h"
#include "render/vk/pipeline.h"
#include "render/xr/swapchain_images.h"

namespace catena::render::xr {

class DepthImages {
 public:
  static constexpr float kNearM = 0.02f, kFarM = 1000;
  static constexpr std::uint32_t kRaySpacing = 8;

  /// Nothing where the runtime takes no depths of 32 bits.
  static std::unique_ptr<DepthImages> create(Session& session, ViewSize size);
  const SwapchainImages& images() const { return *images_; }
  /// Of the renderer's last picture, drawn with ray_depth_spacing. False: it has no depth.
  Result<bool> submit_depth(Renderer& renderer, double metres_per_unit);

 private:
  explicit DepthImages(Session& session) : session_(&session) {}
  Session* session_;
  std::unique_ptr<SwapchainImages> images_;
  vk::Image depth_image_;
  std::array<vk::Pipeline, 4> pipelines_;  // by what there is: 1 something opaque, 2 rays
  vk::Buffer uniform_;
};

}  // namespace catena::render::xr
