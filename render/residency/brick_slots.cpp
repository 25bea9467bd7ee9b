// SPDX-License-Identifier: MIT
#include "render/residency/brick_slots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catena::render {
namespace {

constexpr std::uint32_t kMaxSlotsPerAxis = 255;  // maximum slots per axis; eight bits of a word

}  // namespace

std::uint32_t BrickSlots::pack_slot(std::uint64_t slot) const {
  const auto [x, y, z] = slots_per_axis;
  return std::uint32_t(slot % x | slot / x % y << 8 | slot / x / y << 16);
}

Result<BrickSlots> assign_brick_slots(const vk::Device& device, std::uint64_t count, std::uint32_t texels) {
  const std::uint32_t max_slots = std::min(kMaxSlotsPerAxis, device.info().limits.maxImageDimension3D / texels);
  const double total = std::max(1.0, double(count));
  BrickSlots slots;
  auto& [x, y, z] = slots.slots_per_axis;
  x = std::min(max_slots, std::uint32_t(std::ceil(std::cbrt(total))));
  y = std::min(max_slots, std::uint32_t(std::ceil(std::sqrt(total / x))));
  z = std::uint32_t(std::ceil(total / (double(x) * y)));
  if (z > max_slots) return Error{fmt::format("{} bricks, at most {} fit", count, std::uint64_t(max_slots) * max_slots * max_slots)};
  return slots;
}

}  // namespace catena::render
