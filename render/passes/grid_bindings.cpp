#include "render/passes/grid_bindings.h"

#include <algorithm>

namespace catena::render {
namespace {

constexpr std::uint32_t kValues = 3, kMaps = kValues + MAX_GRIDS, kMasks = kMaps + MAX_GRIDS;

}  // namespace

std::uint32_t BoundGrid::flags() const {
  return (mirror->atlas ? 1u : 0u) | (mirror->masked ? 2u : 0u) | (shaded ? 4u : 0u) | (skips ? 8u : 0u);
}

void add_grid_slots(std::vector<vk::Slot>& slots, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) {
    slots.push_back({kValues + i, vk::Resource::sampled});
    slots.push_back({kMaps + i, vk::Resource::texture});
    slots.push_back({kMasks + i, vk::Resource::texture});
  }
}

void add_grid_bindings(std::vector<vk::Binding>& bindings, std::span<const BoundGrid> grids, std::uint32_t count,
                       const vk::Sampler& linear) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const BoundGrid& g = grids[i < grids.size() ? i : 0];
    bindings.push_back({kValues + i, vk::Resource::sampled, nullptr, &g.mirror->values, &linear});
    bindings.push_back({kMaps + i, vk::Resource::texture, nullptr, &g.map->image, nullptr});
    // without a mask the binding is never read; the map has the right type
    bindings.push_back({kMasks + i, vk::Resource::texture, nullptr, g.mirror->masked ? &g.mirror->mask : &g.map->image, nullptr});
  }
}

}  // namespace catena::render
