// SPDX-License-Identifier: MIT
/// Levels and index of a grid of a store, in the user's cache. Any thread.
#pragma once
#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/field/bricks/brick_index.h"
#include "engine/io/stores/store.h"

namespace catena::field {

/// An open folder of the cache. Values are those that were written, or reading fails: each brick has a checksum in the index.
class CachedLevels {
 public:
  /// Names in the folder.
  static constexpr const char *kIndexName = "/index", *kStoreName = "/levels.zarr";

  /// Opens the folder; null: it has no complete index of data with that identity and these levels of its own, or it is damaged. Where the
  /// folder has levels, the first one is that after the last of `own`; else it has an index of `own`.
  static std::shared_ptr<const CachedLevels> open(const std::string& folder, const std::string& identity,
                                                  const std::vector<StoreLevel>& own);

  /// Returns the index, of the store's own and the cached levels.
  const BrickIndex& index() const { return index_; }
  /// Returns the cached levels, each of half the resolution of the one before; empty: an index only.
  const std::vector<StoreLevel>& levels() const { return levels_; }
  /// Returns the folder.
  const std::string& folder() const { return folder_; }
  /// Reads a box of a cached level, 0: the first one. The Error is a complete message.
  Outcome read(int level, const StoreBox& box, std::span<std::byte> values) const;
  /// Returns whether a brick was missing or wrong; the folder is then not used again.
  bool is_damaged() const { return is_damaged_; }

 private:
  CachedLevels(std::string folder, BrickIndex index) : folder_(std::move(folder)), index_(std::move(index)) {}
  bool open_store(const std::vector<BrickLevel>& expected);
  Outcome read_brick(int level, const Index3& brick, std::span<std::byte> values) const;

  std::string folder_;
  BrickIndex index_;
  std::vector<StoreLevel> levels_;
  std::shared_ptr<Store> store_;
  NumberType type_{};
  std::vector<std::byte> fill_;  ///< One number.
  mutable std::atomic<bool> is_damaged_{false};
};

}  // namespace catena::field
