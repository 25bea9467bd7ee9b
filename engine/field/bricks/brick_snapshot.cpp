// SPDX-License-Identifier: MIT
#include "engine/field/bricks/brick_snapshot.h"

#include <algorithm>
#include <bit>

namespace catena::field {

float Brick::value(int x, int y, int z) const noexcept {
  const std::size_t voxel =
      (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y) + static_cast<std::size_t>(y)) * static_cast<std::size_t>(size_.x) +
      static_cast<std::size_t>(x);
  float out = 0;
  RoundingLoss loss;
  type_.decode(values_.data() + voxel * type_.bytes, 1, 1, 0, &out, loss);
  return out;
}

BrickSnapshot::BrickSnapshot(std::uint64_t number, std::span<const StoredBrick> bricks)
    : number_(number), bricks_(bricks.begin(), bricks.end()), slots_(std::bit_ceil(2 * bricks.size() + 1)) {
  for (const StoredBrick& brick : bricks_) {
    std::size_t distance = 0;
    const std::size_t first = hash(brick.id);
    while (slots_[(first + distance) & (slots_.size() - 1)].values != nullptr) ++distance;
    slots_[(first + distance) & (slots_.size() - 1)] = {brick.id, brick.values.get()};
    max_distance_ = std::max(max_distance_, distance);
  }
}

std::size_t BrickSnapshot::hash(const BrickId& id) noexcept {
  std::uint64_t mixed = (id.number + 0x9E3779B97F4A7C15u * id.grid) * 0xBF58476D1CE4E5B9u;
  mixed ^= mixed >> 31;
  return static_cast<std::size_t>(mixed * 0x94D049BB133111EBu >> 20);
}

const Brick* BrickSnapshot::find(const BrickId& id) const noexcept {
  const std::size_t first = hash(id);
  for (std::size_t distance = 0; distance <= max_distance_; ++distance) {
    const Slot& slot = slots_[(first + distance) & (slots_.size() - 1)];
    if (slot.values == nullptr) return nullptr;
    if (slot.id == id) return slot.values;
  }
  return nullptr;
}

}  // namespace catena::field
