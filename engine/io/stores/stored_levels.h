// SPDX-License-Identifier: MIT
/// All levels of a grid in a store at one time step: its own, then those of the cache (engine/io/levels). Immutable; any thread.
#pragma once
#include <memory>
#include <span>
#include <utility>

#include "engine/field/bricks/brick_source.h"
#include "engine/io/levels/cached_levels.h"
#include "engine/io/stores/store.h"

namespace catena::field {

/// Levels of a grid, by their number.
class StoredLevels {
 public:
  /// The grid, by its index in the description, and the time step exist. `cached`: of this grid and step; null: none.
  StoredLevels(std::shared_ptr<Store> store, int grid, int step, std::shared_ptr<const CachedLevels> cached);

  /// Returns the description of the grid, with the cached levels.
  const StoreGrid& description() const { return description_; }
  /// Returns a level.
  const StoreLevel& at(int level) const { return description_.levels[static_cast<std::size_t>(level)]; }
  /// Returns the number of levels.
  int count() const { return static_cast<int>(description_.levels.size()); }
  /// Reads a box of a level in the stored type, as Store::read() does.
  Outcome read(int level, const StoreBox& box, std::span<std::byte> values) const;
  /// Returns whether range() knows all bricks of a level; always true for a cached level.
  bool is_indexed(int level) const noexcept;
  /// Returns for each brick of one of the store's own levels whether anything is stored for it, x fastest. Blocks.
  Result<std::vector<std::uint8_t>> list(int level) const;
  /// Returns what the index states on a brick.
  BrickRange range(int level, const Index3& brick) const noexcept;
  /// Returns the cached levels; null: none.
  const CachedLevels* cached() const { return cached_.get(); }

 private:
  std::shared_ptr<Store> store_;
  int grid_, step_;
  std::shared_ptr<const CachedLevels> cached_;
  StoreGrid description_;
};

}  // namespace catena::field
