// SPDX-License-Identifier: MIT
/// Soft shadows of the haptic cursors on opaque things and volumes, computed when the image is composed: a moving hand rebuilds nothing.
/// Lights fixed to the scene cast them if the scene has shadows. Frame thread.
#pragma once
#include <vector>

#include "render/passes/cursor_parts.h"
#include "render/passes/pass.h"
#include "shaders/shared/hand_shadow.h"

namespace catena::render {

/// The hand's shadow of one image.
class HandShadow {
 public:
  /// Finds the pixels in which shadows may lie, and the depths of volumes there. To be called before the image's commands are recorded.
  /// `has_opaque`: something opaque is drawn.
  Outcome update(Frame& frame, bool has_opaque, RaySampler* volumes);
  /// Finds the tiles that are drawn. To be called if the area is not empty, before vertex_shader() is used.
  Outcome record_mask(vk::Commands& commands, Frame& frame);
  /// Returns the pixels in which shadows may lie; empty: there are none.
  const VkRect2D& area() const { return area_; }
  /// Returns the number of instances of vertex_shader(), six vertices each: tiles of the area, of which those without a shadow are empty.
  std::uint32_t tile_count() const { return tile_count_; }
  static vk::Spirv vertex_shader();
  /// Returns the layout of bindings().
  static std::vector<vk::LayoutBinding> layout();
  /// Returns the bindings of shaders/lib/hand_shadow.glsl.
  std::vector<vk::Binding> bindings(Targets& targets) const;

 private:
  void find_area(const std::vector<CursorPart>& parts, const FramePacket& packet, const Camera& camera, shared::HandShadowData& data);

  VkRect2D area_{}, mask_area_{};
  vk::Buffer frame_, hand_;
  vk::Image depths_, mask_;
  vk::Pipeline mask_pipeline_;
  std::uint32_t tile_count_ = 0;
  bool has_depths_ = false;
};

}  // namespace catena::render
