// SPDX-License-Identifier: MIT
#include "render/passes/triangles.h"

#include <algorithm>
#include <cstddef>

#include "engine/base/result.h"
#include "render/passes/pass.h"
#include "render/vk/commands.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kTrianglesVertexShader[] = {
#include "spirv/mesh.vert.inc"
};
constexpr std::uint32_t kTrianglesFragmentShader[] = {
#include "spirv/mesh.frag.inc"
};

struct Vertex {
  glm::vec3 position, normal, color;
  std::uint32_t id;
};

}  // namespace

Outcome Triangles::upload(vk::Device& device, const ShapeMesh& shape) {
  index_count_ = 0;
  bounds_ = {};
  if (shape.triangles.empty()) return Done{};
  for (const MeshVertex& v : shape.vertices) bounds_.extend(v.position);
  origin_ = bounds_.center();
  std::vector<Vertex> vertices;
  vertices.reserve(shape.vertices.size());
  for (const MeshVertex& v : shape.vertices)
    vertices.push_back({glm::vec3(v.position - origin_), glm::vec3(v.normal), {v.color.r, v.color.g, v.color.b}, v.id});
  CATENA_TRY(vertices_, vk::upload_buffer(device, std::as_bytes(std::span(vertices)), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT));
  CATENA_TRY(indices_, vk::upload_buffer(device, std::as_bytes(std::span(shape.triangles)), VK_BUFFER_USAGE_INDEX_BUFFER_BIT));
  index_count_ = std::uint32_t(shape.triangles.size());
  return Done{};
}

Result<vk::Binding> Triangles::frame_binding(vk::Device& device, const CameraRays& rays) {
  CATENA_CHECK(vk::write_uniform(device, uniform_, rays.mesh_frame_data(origin_)));
  return vk::Binding{0, vk::DescriptorKind::uniform, &uniform_, nullptr, nullptr};
}

void set_triangle_stage(vk::GraphicsInfo& info) {
  info.vertex = kTrianglesVertexShader;
  info.layout_bindings.push_back({0, vk::DescriptorKind::uniform});
  info.layout_bindings.push_back({vk::kSharedBinding, vk::DescriptorKind::sampled});
  info.vertex_stride = sizeof(Vertex);
  info.attributes = {{0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
                     {1, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, normal)},
                     {2, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, color)},
                     {3, VK_FORMAT_R32_UINT, offsetof(Vertex, id)}};
}

Result<TriangleDrawer> TriangleDrawer::create(vk::Device& device) {
  TriangleDrawer self;
  self.device_ = &device;
  vk::GraphicsInfo info;
  set_triangle_stage(info);
  info.fragment = kTrianglesFragmentShader;
  info.colors = opaque_formats();
  info.has_depth = true;
  CATENA_TRY(self.pipeline_, vk::Pipeline::create(device, info));
  return self;
}

Outcome TriangleDrawer::draw(vk::Commands& commands, const CameraRays& rays, Triangles& triangles) {
  if (triangles.empty()) return Done{};
  CATENA_TRY(const vk::Binding binding, triangles.frame_binding(*device_, rays));
  commands.bind(pipeline_, {&binding, 1});
  triangles.draw(commands);
  return Done{};
}

namespace {

constexpr std::uint32_t kData = 5, kOpaqueDepth = 6, kPassedDepth = 7, kPassedId = 8;

}  // namespace

void set_peel_stage(vk::GraphicsInfo& info, std::uint32_t mode, bool has_opaque) {
  info.layout_bindings.push_back({kData, vk::DescriptorKind::uniform});
  for (const std::uint32_t binding : {kOpaqueDepth, kPassedDepth, kPassedId})
    info.layout_bindings.push_back({binding, vk::DescriptorKind::texture});
  CATENA_ASSERT(info.constants.size() == 1);  // the appended constants have the ids 1 and 2
  info.constants.insert(info.constants.end(), {mode, has_opaque});
  info.colors = opaque_formats();
  info.has_depth = mode != MODE_TAIL;
  if (mode != MODE_TAIL) return;
  info.colors[0] = kTailFormat;
  info.blends = {vk::Blend::accumulate, vk::Blend::min, vk::Blend::keep};
}

void add_peel_bindings(std::vector<vk::Binding>& bindings, const PeelState& peel, const vk::Buffer& layer_data) {
  const auto texture = [&](std::uint32_t binding, const vk::Image* image, const vk::Image* otherwise) {
    bindings.push_back({binding, vk::DescriptorKind::texture, nullptr, image ? image : otherwise, nullptr});
  };
  bindings.push_back({kData, vk::DescriptorKind::uniform, &layer_data, nullptr, nullptr});
  texture(kOpaqueDepth, peel.opaque_depth, peel.placeholder);
  texture(kPassedDepth, peel.previous_depth, peel.placeholder);
  texture(kPassedId, peel.previous_id, peel.placeholder_id);
}

shared::LayerData layer_data(const CameraRays& rays, float opacity) {
  shared::LayerData data{};
  data.reference_depth = float(rays.reference_depth);
  data.depth_near = float(rays.depth_near);
  data.depth_far = float(rays.depth_far);
  data.orthographic = rays.camera.orthographic;
  data.opacity = opacity;
  return data;
}

}  // namespace catena::render
