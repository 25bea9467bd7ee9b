/// Volume over opaque over background, into the finished picture (RGBA8, straight alpha).
#pragma once
#include <map>

#include "render/passes/targets.h"
#include "render/vk/commands.h"

namespace catena::render {

class ComposePass {
 public:
  explicit ComposePass(vk::Device& device) : device_(&device) {}
  /// Moves the targets to their layouts and draws.
  Outcome record(vk::Commands& commands, Targets& targets, const std::array<float, 4>& background, bool opaque, bool volume);

 private:
  vk::Device* device_;
  std::map<std::uint32_t, vk::Pipeline> pipelines_;
  vk::Buffer uniform_;
};

}  // namespace catena::render
