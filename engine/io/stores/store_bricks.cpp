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
    : BrickSource(*find_number_type(store->description().grids[static_cast<std::size_t>(grid)].type),
                  levels_of(store->description().grids[static_cast<std::size_t>(grid)])),
      store_(std::move(store)),
      grid_(grid),
      step_(step),
      fill_value_(store_->description().grids[static_cast<std::size_t>(grid)].fill_value) {
  for (std::size_t level = 0; level < levels().size(); ++level) ranges_.push_back(std::make_unique<Ranges>());
}

BrickRange StoreBricks::range(int level, const Index3& brick) const noexcept {
  Ranges& ranges = *ranges_[static_cast<std::size_t>(level)];
  const std::uint64_t number = brick_number(brick_counts(levels()[static_cast<std::size_t>(level)]), brick);
  const std::scoped_lock lock(ranges.mutex);
  if (!ranges.present.empty() && ranges.present[number] == 0) return {true, false, fill_value_, fill_value_};
  const auto found = ranges.known.find(number);
  return found == ranges.known.end() ? BrickRange{} : found->second;
}

Outcome StoreBricks::read(int level, const Index3& brick, std::span<std::byte> values) const {
  const BrickLevel& at = levels()[static_cast<std::size_t>(level)];
  const StoreBox box{{brick.x * kBrickEdge, brick.y * kBrickEdge, brick.z * kBrickEdge}, brick_size(at, brick)};
  CATENA_CHECK(store_->read(grid_, level, step_, box, values));
  if (this->range(level, brick).is_known) return Done{};
  const BrickRange range = find_range(type(), values, box.size, box.size);
  Ranges& ranges = *ranges_[static_cast<std::size_t>(level)];
  const std::scoped_lock lock(ranges.mutex);
  ranges.known.insert_or_assign(brick_number(brick_counts(at), brick), range);
  return Done{};
}

Outcome StoreBricks::find_empty_bricks(int level) const {
  CATENA_TRY(std::vector<std::uint8_t> present, store_->list(grid_, level, step_));
  Ranges& ranges = *ranges_[static_cast<std::size_t>(level)];
  const std::scoped_lock lock(ranges.mutex);
  ranges.present = std::move(present);
  return Done{};
}

}  // namespace catena::field
