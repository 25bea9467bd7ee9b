/// How a grid is bound for shaders/lib/grids.glsl: value image, brick map and mask at three bindings, four flag bits.
#pragma once
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "render/mirror/brick_map.h"
#include "render/vk/commands.h"
#include "shaders/shared/frame.h"

namespace catena::render {

struct BoundGrid {
  std::shared_ptr<const GridMirror> mirror;
  const BrickMap* map = nullptr;
  bool shaded = false;
  bool skips = false;
  std::uint32_t flags() const;
};

/// The pipeline's slots for `count` grids, and what to push for them: grid i, or the first one where there are fewer.
void add_grid_slots(std::vector<vk::Slot>& slots, std::uint32_t count);
void add_grid_bindings(std::vector<vk::Binding>& bindings, std::span<const BoundGrid> grids, std::uint32_t count,
                       const vk::Sampler& linear);

/// A uniform buffer that the host writes each frame.
template <class Data>
Outcome write_uniform(vk::Device& device, vk::Buffer& buffer, const Data& data) {
  if (!buffer) {
    CATENA_TRY(buffer, vk::Buffer::create(device, sizeof(Data), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, vk::Memory::upload));
  }
  std::memcpy(buffer.bytes().data(), &data, sizeof(Data));
  return Done{};
}

}  // namespace catena::render
