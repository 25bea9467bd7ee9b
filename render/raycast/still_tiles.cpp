#include "render/raycast/still_tiles.h"

#include <cstring>

namespace catena::render {

namespace {

constexpr std::uint32_t kStillTilesVertexShader[] = {
#include "spirv/screen.vert.inc"
};
constexpr std::uint32_t kStillTilesOpaqueShader[] = {
#include "spirv/opaque_tiles.frag.inc"
};
constexpr std::uint32_t kStillTilesChangedShader[] = {
#include "spirv/changed_tiles.frag.inc"
};

constexpr std::uint32_t kStillBlock = 4, kStillTile = 16;
constexpr VkFormat kSignFormat = VK_FORMAT_R32G32_UINT;

/// An image of one texel for so many pixels each way.
Outcome fit_tiles(vk::Device& device, vk::Image& image, VkFormat format, const VkExtent3D& picture, std::uint32_t pixels) {
  constexpr VkImageUsageFlags usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  return vk::fit_image(device, image, format, (picture.width + pixels - 1) / pixels, (picture.height + pixels - 1) / pixels, usage);
}

}  // namespace

bool StillPicture::is(const StillPicture& other) const {
  shared::FrameData a = frame, b = other.frame;
  // what only triangles ask for
  a.depth_near = b.depth_near = a.depth_far = b.depth_far = 0;
  return std::memcmp(&a, &b, sizeof(a)) == 0 && look == other.look && layers == other.layers && target == other.target &&
         target_image == other.target_image && std::memcmp(&area, &other.area, sizeof(area)) == 0 && opaque == other.opaque;
}

Outcome StillTiles::look(vk::Commands& commands, const vk::Image& opaque_depth) {
  if (!look_) {
    vk::GraphicsInfo info;
    info.vertex = kStillTilesVertexShader;
    info.fragment = kStillTilesOpaqueShader;
    info.slots = {{0, vk::Resource::texture}};
    info.colors = {VK_FORMAT_R8_UINT, kSignFormat};
    CATENA_TRY(look_, vk::Pipeline::create(*device_, info));
  }
  const VkExtent3D& picture = opaque_depth.info().extent;
  newest_ = 1 - newest_;
  CATENA_CHECK(fit_tiles(*device_, opaque_, VK_FORMAT_R8_UINT, picture, kStillBlock));
  for (vk::Image& signs : signs_) CATENA_CHECK(fit_tiles(*device_, signs, kSignFormat, picture, kStillBlock));
  const std::array<float, 4> empty{0, 0, 0, 0};
  const vk::ColorTarget targets[] = {{&opaque_, empty}, {&signs_[newest_], empty}};
  commands.begin_pass(targets, {});
  const vk::Binding bindings[] = {{0, vk::Resource::texture, nullptr, &opaque_depth, nullptr}};
  commands.bind(look_, bindings);
  commands.draw_triangle();
  commands.end_pass();
  commands.use(opaque_, vk::kFragmentRead);
  commands.use(signs_[newest_], vk::kFragmentRead);
  return Done{};
}

Outcome StillTiles::find(vk::Commands& commands, int reach, vk::Image& before, vk::Image& now, vk::Image& target) {
  vk::Pipeline& pipeline = find_[reach];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = kStillTilesVertexShader;
    info.fragment = kStillTilesChangedShader;
    info.slots = {{0, vk::Resource::texture}, {1, vk::Resource::texture}};
    info.constants = {std::uint32_t(reach)};
    info.colors = {VK_FORMAT_R8_UINT};
    CATENA_TRY(pipeline, vk::Pipeline::create(*device_, info));
  }
  const vk::ColorTarget color{&target, std::array<float, 4>{0, 0, 0, 0}};
  commands.begin_pass({&color, 1}, {});
  const vk::Binding bindings[] = {{0, vk::Resource::texture, nullptr, &before, nullptr},
                                  {1, vk::Resource::texture, nullptr, &now, nullptr}};
  commands.bind(pipeline, bindings);
  commands.draw_triangle();
  commands.end_pass();
  commands.use(target, vk::kShaderRead);
  return Done{};
}

Outcome StillTiles::find_changed(vk::Commands& commands, int reach) {
  CATENA_ASSERT(signs_[0] && signs_[1]);
  const VkExtent3D& blocks = opaque_.info().extent;
  const VkExtent3D picture{kStillBlock * blocks.width, kStillBlock * blocks.height, 1};
  CATENA_CHECK(fit_tiles(*device_, changed_, VK_FORMAT_R8_UINT, picture, kStillTile));
  if (reach == 0) return find(commands, 0, signs_[1 - newest_], signs_[newest_], changed_);
  CATENA_CHECK(fit_tiles(*device_, near_, VK_FORMAT_R8_UINT, picture, kStillTile));
  CATENA_CHECK(find(commands, 0, signs_[1 - newest_], signs_[newest_], near_));
  return find(commands, reach, near_, near_, changed_);
}

}  // namespace catena::render
