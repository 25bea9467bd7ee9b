// SPDX-License-Identifier: MIT
#include "engine/io/stores/store_bricks.h"

#include "engine/field/bricks/brick_range.h"

namespace catena::field {
namespace {

std::vector<BrickLevel> levels_of(const StoreGrid& grid) {
  std::vector<BrickLevel> levels;
  for (const StoreLevel& level : grid.levels) levels.push_back({level.size, level.mapping});
  return levels;
}

}  // namespace

StoreBricks::StoreBricks(std::shared_ptr<Store> store, int grid, int step)
    : StoreBricks(std::make_shared<const StoredLevels>(std::move(store), grid, step, nullptr)) {}

StoreBricks::StoreBricks(std::shared_ptr<const StoredLevels> stored)
    : BrickSource(*find_number_type(stored->description().type), levels_of(stored->description())), stored_(std::move(stored)) {
  for (std::size_t level = 0; level < levels().size(); ++level) ranges_.push_back(std::make_unique<Ranges>());
}

BrickRange StoreBricks::range(int level, const Index3& brick) const noexcept {
  if (const BrickRange indexed = stored_->range(level, brick); indexed.is_known) return indexed;
  Ranges& ranges = *ranges_[static_cast<std::size_t>(level)];
  const std::uint64_t number = brick_number(brick_counts(levels()[static_cast<std::size_t>(level)]), brick);
  const std::scoped_lock lock(ranges.mutex);
  if (!ranges.present.empty() && ranges.present[number] == 0) {
    const double fill = stored_->description().fill_value;
    return {true, false, fill, fill};
  }
  const auto found = ranges.known.find(number);
  return found == ranges.known.end() ? BrickRange{} : found->second;
}

Outcome StoreBricks::read(int level, const Index3& brick, std::span<std::byte> values) const {
  const BrickLevel& at = levels()[static_cast<std::size_t>(level)];
  const StoreBox box{{brick.x * kBrickEdge, brick.y * kBrickEdge, brick.z * kBrickEdge}, brick_size(at, brick)};
  CATENA_CHECK(stored_->read(level, box, values));
  if (this->range(level, brick).is_known) return Done{};
  const BrickRange range = find_range(type(), values, box.size, box.size);
  Ranges& ranges = *ranges_[static_cast<std::size_t>(level)];
  const std::scoped_lock lock(ranges.mutex);
  ranges.known.insert_or_assign(brick_number(brick_counts(at), brick), range);
  return Done{};
}

double StoreBricks::decoded_voxels(int level) const noexcept {
  const Index3& chunk = stored_->description().levels[static_cast<std::size_t>(level)].chunk;
  const auto along = [](int edge) { return edge > 0 ? double((kBrickEdge - 1) / edge + 1) * edge / kBrickEdge : 1.0; };
  return along(chunk.x) * along(chunk.y) * along(chunk.z);
}

Outcome StoreBricks::find_empty_bricks(int level) const {
  if (stored_->is_indexed(level)) return Done{};
  CATENA_TRY(std::vector<std::uint8_t> present, stored_->list(level));
  Ranges& ranges = *ranges_[static_cast<std::size_t>(level)];
  const std::scoped_lock lock(ranges.mutex);
  ranges.present = std::move(present);
  return Done{};
}

}  // namespace catena::field
