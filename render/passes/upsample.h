/// From a volume on every 2nd pixel to the finished picture, over opaque over background: compose.h for the fast raycast.
#pragma once
#include <map>

#include "render/passes/targets.h"
#include "render/vk/commands.h"

namespace catena::render {

class UpsamplePass {
 public:
  explicit UpsamplePass(vk::Device& device) : device_(&device) {}
  /// `area`: the pixels that the volume may cover. Moves the images to their layouts.
  Outcome record(vk::Commands& commands, vk::Image& half_lattice, Targets& targets, const std::array<float, 4>& background, bool opaque,
                 const VkRect2D& area);

 private:
  vk::Device* device_;
  std::array<vk::Pipeline, 2> pipelines_;  // without and with something opaque
  vk::Buffer uniform_;
};

}  // namespace catena::render
