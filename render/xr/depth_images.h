// SPDX-License-Identifier: MIT
/// Depth of a view's image, used by the runtime to reproject it to the head pose between frames (XR_KHR_composition_layer_depth): depth of
/// opaque objects, and half-opacity depth (alpha exceeds 0.5) of volumes and translucent objects in front of them (from every
/// kRaySpacing-th pixel's ray):
///   d = f / (f - n) (1 - n / z),  z meters from the eye along its axis, n = kNearM and f = kFarM; 1 where there is nothing
/// A projection (maximum, minimum, average) has no depth: that of opaque objects behind it would be too large, and nothing is submitted.
/// Frame thread.
#pragma once
#include <array>
#include <memory>

#include "render/passes/renderer.h"
#include "render/vk/pipeline.h"
#include "render/xr/swapchain_images.h"

namespace catena::render::xr {

/// Depth swapchain of one view.
class DepthImages {
 public:
  static constexpr float kNearM = 0.02f, kFarM = 1000;
  static constexpr std::uint32_t kRaySpacing = 8;

  /// Returns null if the runtime does not support 32-bit depth.
  static std::unique_ptr<DepthImages> create(Session& session, ViewSize size);
  const SwapchainImages& images() const { return *images_; }
  /// Submits the depth of the renderer's last image, rendered with ray_depth_spacing. Returns false if it has no depth.
  Result<bool> submit_depth(Renderer& renderer, double metres_per_unit);

 private:
  explicit DepthImages(Session& session) : session_(&session) {}
  Session* session_;
  std::unique_ptr<SwapchainImages> images_;
  vk::Image depth_image_;
  std::array<vk::Pipeline, 4> pipelines_;  // index bits of the available input: 1 opaque depth, 2 ray depth
  vk::Buffer uniform_;
};

}  // namespace catena::render::xr
