/// Lit triangles into the opaque targets: what meshes, streamlines and the cursor have in common.
#pragma once
#include "render/passes/pass.h"
#include "render/passes/shapes.h"
#include "render/raycast/camera_rays.h"
#include "render/vk/commands.h"
#include "shaders/shared/layers.h"

namespace catena::render {

/// A shape on the device.
class Triangles {
 public:
  Outcome upload(vk::Device& device, const ShapeMesh& shape);
  const Bounds& bounds() const { return bounds_; }
  bool empty() const { return index_count_ == 0; }
  /// Writes the frame's numbers and binds them at 0.
  Result<vk::Binding> frame_binding(vk::Device& device, const CameraRays& rays);
  void draw(vk::Commands& commands) const { draw(commands, index_count_); }
  /// The first of them: a multiple of three indices.
  void draw(vk::Commands& commands, std::uint32_t indices) const { commands.draw_indexed(vertices_, indices_, indices); }

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
  /// CellFinder a pass over target::opaque.
  Outcome draw(vk::Commands& commands, const CameraRays& rays, Triangles& triangles);

 private:
  TriangleDrawer() = default;
  vk::Device* device_ = nullptr;
  vk::Pipeline pipeline_;
};

/// How a thing is drawn into the opaque targets or into a translucent layer: the bindings and constants of shaders/lib/peel.glsl.

/// Where something is drawn.
struct PeelState {
  std::uint32_t mode = MODE_OPAQUE;
  const vk::Image* opaque_depth = nullptr;    ///< null: nothing opaque
  const vk::Image* previous_depth = nullptr;  ///< of the layer before; null: there is none
  const vk::Image* previous_id = nullptr;
  const vk::Image* placeholder = nullptr;     ///< bound where the others are null
  const vk::Image* placeholder_id = nullptr;  ///< the same for ids

  bool has_opaque() const { return opaque_depth != nullptr; }
};

inline constexpr VkFormat kTailFormat = VK_FORMAT_R32G32B32A32_SFLOAT;  ///< what lies behind the layers, collected

/// Slots, targets, depth and blending of a pipeline for a mode; constants 1 and 2 follow the caller's constant 0.
void set_peel_stage(vk::GraphicsInfo& info, std::uint32_t mode, bool has_opaque);
void add_peel_bindings(std::vector<vk::Binding>& bindings, const PeelState& peel, const vk::Buffer& layer_data);
shared::LayerData layer_data(const CameraRays& rays, float opacity);

}  // namespace catena::render
