/// Lit triangles into the opaque targets: what meshes, streamlines and the cursor have in common.
#pragma once
#include "render/passes/shapes.h"
#include "render/raycast/camera_rays.h"
#include "render/vk/commands.h"

namespace catena::render {

/// A shape on the device.
class Triangles {
 public:
  Outcome upload(vk::Device& device, const Shape& shape);
  const Bounds& bounds() const { return bounds_; }
  bool empty() const { return index_count_ == 0; }
  /// Writes the frame's numbers and binds them at 0.
  Result<vk::Binding> frame_binding(vk::Device& device, const CameraRays& rays);
  void draw(vk::Commands& commands) const { commands.draw_indexed(vertices_, indices_, index_count_); }

 private:
  vk::Buffer vertices_, indices_, uniform_;
  std::uint32_t index_count_ = 0;
  Vec3 origin_{0.0};
  Bounds bounds_;
};

/// The vertex stage of every pipeline that draws Triangles.
void set_triangle_stage(vk::GraphicsInfo& info);

/// Clip planes hold for vertices without shared::UNCLIPPED in their id.
class TriangleDrawer {
 public:
  static Result<TriangleDrawer> create(vk::Device& device);
  /// Within a pass over target::opaque.
  Outcome draw(vk::Commands& commands, const CameraRays& rays, Triangles& triangles);

 private:
  TriangleDrawer() = default;
  vk::Device* device_ = nullptr;
  vk::Pipeline pipeline_;
};

}  // namespace catena::render
