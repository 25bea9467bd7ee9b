// SPDX-License-Identifier: MIT
/// Soft shadows of the haptic cursors on opaque things and volumes, computed when the image is composed: a moving hand rebuilds nothing.
/// Lights fixed to the scene cast them if the scene has shadows. Frame thread.
#pragma once
#include <vector>

#include "render/passes/pass.h"
#include "shaders/shared/hand_shadow.h"

namespace catena::render {

/// The hand's shadow of one image.
class HandShadow {
 public:
  /// Finds the pixels in which shadows may lie, and the depths of volumes there. To be called before the image's commands are recorded.
  Outcome update(Frame& frame, RaySampler* volumes);
  /// Returns the pixels in which shadows may lie; empty: there are none.
  const VkRect2D& area() const { return area_; }
  /// Returns the layout of bindings().
  static std::vector<vk::LayoutBinding> layout();
  /// Returns the bindings of shaders/lib/hand_shadow.glsl.
  std::vector<vk::Binding> bindings(Targets& targets) const;

 private:
  Outcome draw_depths(Frame& frame, RaySampler& volumes, shared::HandShadowData& data);

  VkRect2D area_{};
  vk::Buffer frame_, hand_;
  vk::Image depths_;
  bool has_depths_ = false;
};

}  // namespace catena::render
