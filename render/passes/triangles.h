// SPDX-License-Identifier: MIT
/// Lit triangles in the opaque targets: common part of the mesh, streamline, glyph and cursor passes.
#pragma once
#include "render/passes/pass.h"
#include "render/passes/shapes.h"
#include "render/raycast/camera_rays.h"
#include "render/vk/commands.h"
#include "shaders/shared/layers.h"

namespace catena::render {

/// Triangle mesh on the device.
class Triangles {
 public:
  /// Replaces the mesh. An Error if there is no memory.
  Outcome upload(vk::Device& device, const ShapeMesh& shape);
  const Bounds& bounds() const { return bounds_; }
  bool empty() const { return index_count_ == 0; }
  /// Writes the frame's uniform data and returns its binding at 0.
  Result<vk::Binding> frame_binding(vk::Device& device, const CameraRays& rays);
  void draw(vk::Commands& commands) const { draw(commands, index_count_); }
  /// Draws the first `indices` indices, a multiple of three.
  void draw(vk::Commands& commands, std::uint32_t indices) const { commands.draw_indexed(vertices_, indices_, indices); }

 private:
  vk::Buffer vertices_, indices_, uniform_;
  std::uint32_t index_count_ = 0;
  Vec3 origin_{0.0};
  Bounds bounds_;
};

/// Sets the vertex stage of a pipeline that draws Triangles.
void set_triangle_stage(vk::GraphicsInfo& info);

/// Renders lit triangles. Clip planes apply to vertices without shared::UNCLIPPED in their id.
class TriangleDrawer {
 public:
  static Result<TriangleDrawer> create(vk::Device& device);
  /// Records the triangles in a render pass over target::opaque.
  Outcome draw(vk::Commands& commands, const CameraRays& rays, Triangles& triangles);

 private:
  TriangleDrawer() = default;
  vk::Device* device_ = nullptr;
  vk::Pipeline pipeline_;
};

/// Rendering into the opaque targets or into a translucent layer (depth peeling): bindings and constants of shaders/lib/peel.glsl.

/// Target of a draw: mode and input images.
struct PeelState {
  std::uint32_t mode = MODE_OPAQUE;
  const vk::Image* opaque_depth = nullptr;    ///< null: nothing opaque
  const vk::Image* previous_depth = nullptr;  ///< depth of the previous layer; null: there is none
  const vk::Image* previous_id = nullptr;     ///< ids of the previous layer
  const vk::Image* placeholder = nullptr;     ///< bound where the depth images are null
  const vk::Image* placeholder_id = nullptr;  ///< bound where the id image is null

  bool has_opaque() const { return opaque_depth != nullptr; }
};

inline constexpr VkFormat kTailFormat = VK_FORMAT_R32G32B32A32_SFLOAT;  ///< format of the tail: mean of what lies behind the peeled layers

/// Sets bindings, targets, depth test and blending of a pipeline for a mode; adds constants 1 and 2 after the caller's constant 0.
void set_peel_stage(vk::GraphicsInfo& info, std::uint32_t mode, bool has_opaque);
/// Appends the bindings for the peel state.
void add_peel_bindings(std::vector<vk::Binding>& bindings, const PeelState& peel, const vk::Buffer& layer_data);
/// Returns the shader data of a layer.
shared::LayerData layer_data(const CameraRays& rays, float opacity);

}  // namespace catena::render
