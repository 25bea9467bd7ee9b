#include "render/raycast/upsample.h"

#include "render/raycast/bound_grids.h"
#include "render/vk/upload.h"
#include "shaders/shared/fast_volume.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kUpsampleShader[] = {
#include "spirv/upsample.comp.inc"
};
constexpr std::uint32_t kGroupX = 16, kGroupY = 4;  // as in the shaders

}  // namespace

UpsampleGroups upsample_groups(const VkRect2D& area, const VkExtent3D& picture) {
  UpsampleGroups groups;
  groups.data.first_x = std::uint32_t(area.offset.x) / 2;
  groups.data.first_y = std::uint32_t(area.offset.y) / 2;
  groups.data.width = picture.width;
  groups.data.height = picture.height;
  const auto points = [](std::int32_t first, std::uint32_t extent) {
    return extent == 0 ? 0 : (std::uint32_t(first) % 2 + extent + 1) / 2;
  };
  groups.x = (points(area.offset.x, area.extent.width) + kGroupX - 1) / kGroupX;
  groups.y = (points(area.offset.y, area.extent.height) + kGroupY - 1) / kGroupY;
  return groups;
}

Outcome Upsampler::record(vk::Commands& commands, vk::Image& half_lattice, vk::Image* opaque, const vk::Image& none,
                          const std::array<float, 4>& background, const VkRect2D& area, vk::Image& picture) {
  vk::Pipeline& pipeline = pipelines_[opaque ? 1 : 0];
  if (!pipeline) {
    vk::ComputeInfo info;
    info.shader = kUpsampleShader;
    info.slots = {{0, vk::Resource::uniform}, {1, vk::Resource::texture}, {2, vk::Resource::texture}, {3, vk::Resource::storage_image}};
    info.constants = {opaque ? 1u : 0u};
    CATENA_TRY(pipeline, vk::Pipeline::create(*device_, info));
  }
  const VkExtent3D& size = picture.info().extent;
  VkRect2D pixels = area;
  if (opaque) {
    pixels = {{0, 0}, {size.width, size.height}};
    commands.use(*opaque, vk::kFragmentRead);
  } else {
    // beyond the area there is the background
    const bool seen = background[3] > 0;
    const vk::ColorTarget target{&picture, seen ? background : std::array<float, 4>{0, 0, 0, 0}};
    commands.begin_pass({&target, 1}, {});
    commands.end_pass();
  }
  UpsampleGroups groups = upsample_groups(pixels, size);
  groups.data.background = {background[0], background[1], background[2], background[3]};
  CATENA_CHECK(vk::write_uniform(*device_, uniform_, groups.data));
  commands.use(half_lattice, vk::kFragmentRead);
  commands.use(picture, vk::kComputeWrite);
  const vk::Binding bindings[] = {{0, vk::Resource::uniform, &uniform_, nullptr, nullptr},
                                  {1, vk::Resource::texture, nullptr, opaque ? opaque : &none, nullptr},
                                  {2, vk::Resource::texture, nullptr, &half_lattice, nullptr},
                                  {3, vk::Resource::storage_image, nullptr, &picture, nullptr}};
  commands.bind(pipeline, bindings);
  if (groups.x > 0 && groups.y > 0) commands.dispatch(groups.x, groups.y, 1);
  commands.use(picture, vk::kTransferRead);
  return Done{};
}

}  // namespace catena::render
