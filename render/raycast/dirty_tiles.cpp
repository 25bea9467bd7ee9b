// SPDX-License-Identifier: MIT
#include "render/raycast/dirty_tiles.h"

#include <cstring>

namespace catena::render {

namespace {

constexpr std::uint32_t kDirtyTileQuadsShader[] = {
#include "spirv/fullscreen.vert.inc"
};
constexpr std::uint32_t kOpaqueTilesShader[] = {
#include "spirv/opaque_tiles.frag.inc"
};
constexpr std::uint32_t kDirtyTilesShader[] = {
#include "spirv/dirty_tiles.frag.inc"
};

constexpr std::uint32_t kBlockPixels = 4, kTilePixels = 16;
constexpr VkFormat kHashFormat = VK_FORMAT_R32G32_UINT;

/// Makes an image with one texel per `pixels` x `pixels` tile.
Outcome fit_tiles(vk::Device& device, vk::Image& image, VkFormat format, const VkExtent3D& image_size, std::uint32_t pixels) {
  constexpr VkImageUsageFlags usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  return vk::ensure_image(device, image, format, (image_size.width + pixels - 1) / pixels, (image_size.height + pixels - 1) / pixels,
                          usage);
}

}  // namespace

bool RayImageState::matches(const RayImageState& other) const {
  shared::FrameData a = frame, b = other.frame;
  // only triangles depend on near and far
  a.depth_near = b.depth_near = a.depth_far = b.depth_far = 0;
  return std::memcmp(&a, &b, sizeof(a)) == 0 && appearance_version == other.appearance_version && layers_version == other.layers_version &&
         target == other.target && target_image == other.target_image && std::memcmp(&area, &other.area, sizeof(area)) == 0 &&
         has_opaque == other.has_opaque;
}

Outcome DirtyTiles::analyze(vk::Commands& commands, const vk::Image& opaque_depth) {
  if (!analyze_pipeline_) {
    vk::GraphicsInfo info;
    info.vertex = kDirtyTileQuadsShader;
    info.fragment = kOpaqueTilesShader;
    info.layout_bindings = {{0, vk::DescriptorKind::texture}};
    info.colors = {VK_FORMAT_R8_UINT, kHashFormat};
    CATENA_TRY(analyze_pipeline_, vk::Pipeline::create(*device_, info));
  }
  const VkExtent3D& image_size = opaque_depth.info().extent;
  latest_ = 1 - latest_;
  CATENA_CHECK(fit_tiles(*device_, opaque_tiles_, VK_FORMAT_R8_UINT, image_size, kBlockPixels));
  for (vk::Image& hashes : depth_hashes_) CATENA_CHECK(fit_tiles(*device_, hashes, kHashFormat, image_size, kBlockPixels));
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

Outcome DirtyTiles::find_tiles(vk::Commands& commands, int distance, vk::Image& before, vk::Image& now, vk::Image& target) {
  vk::Pipeline& pipeline = find_pipelines_[distance];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = kDirtyTileQuadsShader;
    info.fragment = kDirtyTilesShader;
    info.layout_bindings = {{0, vk::DescriptorKind::texture}, {1, vk::DescriptorKind::texture}};
    info.constants = {std::uint32_t(distance)};
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

Outcome DirtyTiles::find_dirty(vk::Commands& commands, int distance) {
  CATENA_ASSERT(depth_hashes_[0] && depth_hashes_[1]);
  const VkExtent3D& blocks = opaque_tiles_.info().extent;
  const VkExtent3D image_size{kBlockPixels * blocks.width, kBlockPixels * blocks.height, 1};
  CATENA_CHECK(fit_tiles(*device_, dirty_tiles_, VK_FORMAT_R8_UINT, image_size, kTilePixels));
  if (distance == 0) return find_tiles(commands, 0, depth_hashes_[1 - latest_], depth_hashes_[latest_], dirty_tiles_);
  CATENA_CHECK(fit_tiles(*device_, near_dirty_, VK_FORMAT_R8_UINT, image_size, kTilePixels));
  CATENA_CHECK(find_tiles(commands, 0, depth_hashes_[1 - latest_], depth_hashes_[latest_], near_dirty_));
  return find_tiles(commands, distance, near_dirty_, near_dirty_, dirty_tiles_);
}

}  // namespace catena::render
