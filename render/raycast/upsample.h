/// From a volume on every 2nd pixel to the finished picture, over opaque over background: compose.h for the fast raycast.
#pragma once
#include <array>

#include "render/vk/commands.h"
#include "shaders/shared/fast_volume.h"

namespace catena::render {

/// One invocation a lattice point: what upsample.comp and interpolate.comp need for the pixels of an area.
struct UpsampleGroups {
  shared::UpsampleData data{};
  std::uint32_t x = 0, y = 0;
};
UpsampleGroups upsample_groups(const VkRect2D& area, const VkExtent3D& picture);

class Upsampler {
 public:
  explicit Upsampler(vk::Device& device) : device_(&device) {}
  /// Into `picture`. `opaque` null: there is nothing opaque, `none` is bound instead. `area`: the pixels that the volume may cover. Moves
  /// the images to their layouts.
  Outcome record(vk::Commands& commands, vk::Image& half_lattice, vk::Image* opaque, const vk::Image& none,
                 const std::array<float, 4>& background, const VkRect2D& area, vk::Image& picture);

 private:
  vk::Device* device_;
  std::array<vk::Pipeline, 2> pipelines_;  // without and with something opaque
  vk::Buffer uniform_;
};

}  // namespace catena::render
