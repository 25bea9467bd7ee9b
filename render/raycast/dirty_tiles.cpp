// SPDX-License-Identifier: MIT
#include "render/raycast/dirty_tiles.h"

#include <cstring>

namespace catena::render {

namespace {

constexpr std::uint32_t kStillTilesVertexShader[] = {
#include "spirv/fullscreen.vert.inc"
};
constexpr std::uint32_t kStillTilesOpaqueShader[] = {
#include "spirv/opaque_tiles.frag.inc"
};
constexpr std::uint32_t kStillTilesChangedShader[] = {
#include "spirv/dirty_tiles.frag.inc"
};

constexpr std::uint32_t kStillBlock = 4, kStillTile = 16;
constexpr VkFormat kSignFormat = VK_FORMAT_R32G32_UINT;

/// An image of one texel for so many pixels each way.
Outcome fit_tiles(vk::Device& device, vk::Image& image, VkFormat format, const VkExtent3D& picture, std::uint32_t pixels) {
  constexpr VkImageUsageFlags usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  return vk::ensure_image(device, image, format, (picture.width + pixels - 1) / pixels, (picture.height + pixels - 1) / pixels, usage);
}

}  // namespace

bool RayImageState::matches(const RayImageState& other) const {
  shared::FrameData a = frame, b = other.frame;
  // what only triangles ask for
  a.depth_near = b.depth_near = a.depth_far = b.depth_far = 0;
  return std::memcmp(&a, &b, sizeof(a)) == 0 && appearance_version == other.appearance_version && layers_version == other.layers_version &&
         target == other.target && target_image == other.target_image && std::memcmp(&area, &other.area, sizeof(area)) == 0 &&
         has_opaque == other.has_opaque;
}

Outcome DirtyTiles::analyze(vk::Commands& commands, const vk::Image& opaque_depth) {
  if (!analyze_pipeline_) {
    vk::GraphicsInfo info;
    info.vertex = kStillTilesVertexShader;
    info.fragment = kStillTilesOpaqueShader;
    info.layout_bindings = {{0, vk::DescriptorKind::texture}};
    info.colors = {VK_FORMAT_R8_UINT, kSignFormat};
    CATENA_TRY(analyze_pipeline_, vk::Pipeline::create(*device_, info));
  }
  const VkExtent3D& picture = opaque_depth.info().extent;
  latest_ = 1 - latest_;
  CATENA_CHECK(fit_tiles(*device_, opaque_tiles_, VK_FORMAT_R8_UINT, picture, kStillBlock));
  for (vk::Image& signs : depth_hashes_) CATENA_CHECK(fit_tiles(*device_, signs, kSignFormat, picture, kStillBlock));
  const std::array<float, 4> empty{0, 0, 0, 0};
  const vk::ColorTarget targets[] = {{&opaque_tiles_, empty}, {&depth_hashes_[latest_], empty}};
  commands.begin_pass(targets, {});
  const vk::Binding bindings[] = {{0, vk::DescriptorKind::texture, nullptr, &opaque_depth, nullptr}};
  commands.bind(analyze_pipeline_, bindings);
  commands.draw_triangle();
  commands.end_pass();
  commands.transition(opaque_tiles_, vk::kFragmentRead);
  commands.transition(depth_hashes_[latest_], vk::kFragmentRead);
  return Done{};
}

Outcome DirtyTiles::find_tiles(vk::Commands& commands, int reach, vk::Image& before, vk::Image& now, vk::Image& target) {
  vk::Pipeline& pipeline = find_pipelines_[reach];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = kStillTilesVertexShader;
    info.fragment = kStillTilesChangedShader;
    info.layout_bindings = {{0, vk::DescriptorKind::texture}, {1, vk::DescriptorKind::texture}};
    info.constants = {std::uint32_t(reach)};
    info.colors = {VK_FORMAT_R8_UINT};
    CATENA_TRY(pipeline, vk::Pipeline::create(*device_, info));
  }
  const vk::ColorTarget color{&target, std::array<float, 4>{0, 0, 0, 0}};
  commands.begin_pass({&color, 1}, {});
  const vk::Binding bindings[] = {{0, vk::DescriptorKind::texture, nullptr, &before, nullptr},
                                  {1, vk::DescriptorKind::texture, nullptr, &now, nullptr}};
  commands.bind(pipeline, bindings);
  commands.draw_triangle();
  commands.end_pass();
  commands.transition(target, vk::kShaderRead);
  return Done{};
}

Outcome DirtyTiles::find_dirty(vk::Commands& commands, int reach) {
  CATENA_ASSERT(depth_hashes_[0] && depth_hashes_[1]);
  const VkExtent3D& blocks = opaque_tiles_.info().extent;
  const VkExtent3D picture{kStillBlock * blocks.width, kStillBlock * blocks.height, 1};
  CATENA_CHECK(fit_tiles(*device_, dirty_tiles_, VK_FORMAT_R8_UINT, picture, kStillTile));
  if (reach == 0) return find_tiles(commands, 0, depth_hashes_[1 - latest_], depth_hashes_[latest_], dirty_tiles_);
  CATENA_CHECK(fit_tiles(*device_, near_dirty_, VK_FORMAT_R8_UINT, picture, kStillTile));
  CATENA_CHECK(find_tiles(commands, 0, depth_hashes_[1 - latest_], depth_hashes_[latest_], near_dirty_));
  return find_tiles(commands, reach, near_dirty_, near_dirty_, dirty_tiles_);
}

}  // namespace catena::render
