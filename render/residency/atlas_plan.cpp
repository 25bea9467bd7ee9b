// SPDX-License-Identifier: MIT
#include "render/residency/atlas_plan.h"

#include <cmath>
#include <unordered_map>

#include "engine/base/threads.h"
#include "render/residency/brick_slots.h"

namespace catena::render {

using field::Index3;

Index3 AtlasPlan::first_voxel(std::size_t brick) const {
  const auto bx = std::size_t(bricks[0]), by = std::size_t(bricks[1]);
  return {origin.x + kBrickSize * int(brick % bx), origin.y + kBrickSize * int(brick / bx % by),
          origin.z + kBrickSize * int(brick / bx / by)};
}

/// A brick is constant if its block and the seven blocks that its apron touches have one value.
AtlasPlan plan_atlas(const field::ScalarGrid& grid, const Index3& first, const std::array<std::int32_t, 3>& bricks) {
  const auto [bx, by, bz] = bricks;
  // blocks of one value; one more per axis for the aprons
  const int cx = bx + 1, cy = by + 1;
  std::vector<std::uint8_t> constant(std::size_t(cx) * cy * (bz + 1));
  std::vector<float> value(constant.size());
  parallel_for(constant.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Index3 at{first.x + kBrickSize * int(i % cx), first.y + kBrickSize * int(i / cx % cy), first.z + kBrickSize * int(i / cx / cy)};
      constant[i] = grid.is_constant_block(at, value[i]) && std::isfinite(value[i]);
    }
  });
  AtlasPlan plan{first, bricks, {}, {}, 0};
  plan.is_constant.reserve(std::size_t(bx) * by * bz);
  plan.constant_values.reserve(std::size_t(bx) * by * bz);
  for (int z = 0; z < bz; ++z)
    for (int y = 0; y < by; ++y)
      for (int x = 0; x < bx; ++x) {
        bool same = !grid.has_mask();
        const auto at = [&](int c) { return (std::size_t(z + (c >> 2)) * cy + y + (c >> 1 & 1)) * cx + x + (c & 1); };
        for (int c = 0; c < 8 && same; ++c) same = constant[at(c)] && value[at(c)] == value[at(0)];
        plan.is_constant.push_back(same);
        plan.constant_values.push_back(value[at(0)]);
        plan.stored_count += !same;
      }
  return plan;
}

Result<AtlasSlots> assign_slots(const vk::Device& device, const AtlasPlan& plan) {
  const std::size_t count = plan.is_constant.size();
  AtlasSlots out;
  std::vector<std::uint32_t> linear(count);
  std::unordered_map<float, std::uint32_t> shared;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t slot = std::uint32_t(out.slot_bricks.size());
    if (plan.is_constant[i]) {
      const auto [found, added] = shared.try_emplace(plan.constant_values[i], slot);
      slot = found->second;
      if (added) out.slot_bricks.push_back(i);
    } else {
      out.slot_bricks.push_back(i);
    }
    linear[i] = slot;
  }
  CATENA_TRY(const BrickSlots slots, assign_brick_slots(device, out.slot_bricks.size(), kPaddedBrickSize));
  out.slots_per_axis = slots.slots_per_axis;
  out.brick_words.resize(count);
  for (std::size_t i = 0; i < count; ++i) out.brick_words[i] = slots.pack_slot(linear[i]);
  return out;
}

}  // namespace catena::render
