// SPDX-License-Identifier: MIT
#include "render/xr/depth_images.h"

#include "shaders/shared/headset.h"

namespace catena::render::xr {

namespace {

constexpr std::uint32_t kHeadsetVertexShader[] = {
#include "spirv/fullscreen.vert.inc"
};
constexpr std::uint32_t kHeadsetDepthShader[] = {
#include "spirv/headset_depth.frag.inc"
};

}  // namespace

std::unique_ptr<DepthImages> DepthImages::create(Session& session, ViewSize size) {
  if (!session.instance().capabilities().depth) return nullptr;
  std::unique_ptr<DepthImages> self(new DepthImages(session));
  auto images = SwapchainImages::create(session, size, SwapchainContent::depth);
  if (!images) return nullptr;
  self->images_ = std::move(*images);
  return self;
}

Result<bool> DepthImages::submit_depth(Renderer& renderer, double metres_per_unit) {
  const auto opaque = renderer.opaque_depth();
  const auto rays = renderer.ray_depth();
  if (!opaque && !rays) return false;
  CATENA_ASSERT(!rays || rays->spacing == kRaySpacing);
  vk::Device& device = session_->device();
  const VkExtent3D extent = renderer.output_image().info().extent;
  CATENA_CHECK(vk::ensure_image(device, depth_image_, VK_FORMAT_D32_SFLOAT, extent.width, extent.height,
                                VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT));
  vk::Pipeline& pipeline = pipelines_[(opaque ? 1 : 0) + (rays ? 2 : 0)];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = kHeadsetVertexShader;
    info.fragment = kHeadsetDepthShader;
    info.layout_bindings = {{0, vk::DescriptorKind::uniform}, {1, vk::DescriptorKind::texture}, {2, vk::DescriptorKind::texture}};
    info.has_depth = true;
    info.constants = {opaque.has_value(), rays ? kRaySpacing : 0};
    CATENA_TRY(pipeline, vk::Pipeline::create(device, info));
  }
  const double reference = opaque ? opaque->reference_depth : rays->reference_depth;
  const shared::HeadsetDepthData data{float(metres_per_unit), float(metres_per_unit * reference), kNearM, kFarM};
  CATENA_CHECK(vk::write_uniform(device, uniform_, data));
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(device));
  vk::Image* const none = &renderer.placeholder_image();
  for (vk::Image* image : {opaque ? opaque->image : none, rays ? rays->image : none}) commands.transition(*image, vk::kFragmentRead);
  commands.begin_pass({}, {&depth_image_, 0.0f});
  const vk::Binding bindings[] = {{0, vk::DescriptorKind::uniform, &uniform_, nullptr, nullptr},
                                  {1, vk::DescriptorKind::texture, nullptr, opaque ? opaque->image : none, nullptr},
                                  {2, vk::DescriptorKind::texture, nullptr, rays ? rays->image : none, nullptr}};
  commands.bind(pipeline, bindings);
  commands.draw_triangle();
  commands.end_pass();
  commands.transition(depth_image_, vk::kTransferRead);
  CATENA_CHECK(commands.finish());
  CATENA_CHECK(images_->submit_image(depth_image_));
  return true;
}

}  // namespace catena::render::xr
