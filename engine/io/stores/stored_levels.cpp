// SPDX-License-Identifier: MIT
#include "engine/io/stores/stored_levels.h"

namespace catena::field {

StoredLevels::StoredLevels(std::shared_ptr<Store> store, int grid, int step, std::shared_ptr<const CachedLevels> cached)
    : store_(std::move(store)),
      grid_(grid),
      step_(step),
      cached_(std::move(cached)),
      description_(store_->description().grids[static_cast<std::size_t>(grid)]) {
  if (cached_) description_.levels.insert(description_.levels.end(), cached_->levels().begin(), cached_->levels().end());
}

Outcome StoredLevels::read(int level, const StoreBox& box, std::span<std::byte> values) const {
  const int own = count() - (cached_ ? static_cast<int>(cached_->levels().size()) : 0);
  if (level < own) return store_->read(grid_, level, step_, box, values);
  return cached_->read(level - own, box, values);
}

bool StoredLevels::is_indexed(int level) const noexcept {
  if (!cached_) return false;
  const BrickIndex& index = cached_->index();
  return level >= index.first_level && level < index.first_level + static_cast<int>(index.levels.size());
}

Result<std::vector<std::uint8_t>> StoredLevels::list(int level) const { return store_->list(grid_, level, step_); }

BrickRange StoredLevels::range(int level, const Index3& brick) const noexcept {
  return cached_ ? cached_->index().range(level, brick) : BrickRange{};
}

}  // namespace catena::field
