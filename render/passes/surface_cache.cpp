// SPDX-License-Identifier: MIT
#include "render/passes/surface_cache.h"

#include <cstring>

#include "render/passes/pass.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kSurfaceCacheVertexShader[] = {
#include "spirv/fullscreen.vert.inc"
};
constexpr std::uint32_t kSurfaceCacheFragmentShader[] = {
#include "spirv/surface_cache.frag.inc"
};

}  // namespace

bool SurfaceCache::Key::matches(const Key& other) const {
  if (version != other.version || surfaces.size() != other.surfaces.size()) return false;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    shared::FrameData a = surfaces[i], b = other.surfaces[i];
    // near and far depend on everything drawn; the drawn image uses its own
    a.depth_near = b.depth_near = a.depth_far = b.depth_far = 0;
    if (std::memcmp(&a, &b, sizeof(a)) != 0) return false;
  }
  return true;
}

Outcome SurfaceCache::ensure(vk::Device& device, const VkExtent3D& extent) {
  const VkExtent3D& have = color_.info().extent;
  if (key_ && have.width == extent.width && have.height == extent.height) return Done{};
  key_.reset();
  reused_previous_ = false;
  CATENA_CHECK(vk::ensure_image(device, color_, kOpaqueFormat, extent.width, extent.height));
  CATENA_CHECK(vk::ensure_image(device, depth_, kDepthValueFormat, extent.width, extent.height));
  CATENA_CHECK(vk::ensure_image(device, id_, kIdFormat, extent.width, extent.height));
  return vk::ensure_image(device, depth_buffer_, kDepthBufferFormat, extent.width, extent.height,
                          VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
}

Outcome SurfaceCache::update(vk::Commands& commands, Key key, const std::function<Outcome()>& draw) {
  reused_previous_ = key_ && key_->matches(key);
  if (reused_previous_) return Done{};
  key_.reset();
  const std::array<float, 4> empty{0, 0, 0, 0}, far{NO_DEPTH, 0, 0, 0};
  const vk::ColorTarget targets[] = {{&color_, empty}, {&depth_, far}, {&id_, empty}};
  commands.begin_pass(targets, {&depth_buffer_, 0.0f});
  CATENA_CHECK(draw());
  commands.end_pass();
  for (vk::Image* image : {&color_, &depth_, &id_}) commands.transition(*image, vk::kFragmentRead);
  key_ = std::move(key);
  return Done{};
}

Outcome SurfaceCache::draw(vk::Device& device, vk::Commands& commands, const shared::FrameData& frame) {
  if (!pipeline_) {
    vk::GraphicsInfo info;
    info.vertex = kSurfaceCacheVertexShader;
    info.fragment = kSurfaceCacheFragmentShader;
    info.layout_bindings = {{0, vk::DescriptorKind::uniform},
                            {1, vk::DescriptorKind::texture},
                            {2, vk::DescriptorKind::texture},
                            {3, vk::DescriptorKind::texture}};
    info.colors = opaque_formats();
    info.has_depth = true;
    CATENA_TRY(pipeline_, vk::Pipeline::create(device, info));
  }
  CATENA_CHECK(vk::write_uniform(device, uniform_, frame));
  const vk::Binding bindings[] = {{0, vk::DescriptorKind::uniform, &uniform_, nullptr, nullptr},
                                  {1, vk::DescriptorKind::texture, nullptr, &color_, nullptr},
                                  {2, vk::DescriptorKind::texture, nullptr, &depth_, nullptr},
                                  {3, vk::DescriptorKind::texture, nullptr, &id_, nullptr}};
  commands.bind(pipeline_, bindings);
  commands.draw_triangle();
  return Done{};
}

}  // namespace catena::render
