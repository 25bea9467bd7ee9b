// SPDX-License-Identifier: MIT
/// Bricks of a grid in a store, at one time step. Any thread.
#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "engine/field/bricks/brick_source.h"
#include "engine/io/stores/stored_levels.h"

namespace catena::field {

/// Ranges are known from the index, if the levels have one, and else become known when bricks are read, and by find_empty_bricks().
class StoreBricks final : public BrickSource {
 public:
  /// Makes the source of a grid, by its index in the description, at a time step. Both exist.
  StoreBricks(std::shared_ptr<Store> store, int grid, int step);
  /// Makes the source of all levels of a grid.
  explicit StoreBricks(std::shared_ptr<const StoredLevels> stored);

  BrickRange range(int level, const Index3& brick) const noexcept override;
  Outcome read(int level, const Index3& brick, std::span<std::byte> values) const override;

  double decoded_voxels(int level) const noexcept override;
  /// Lists the store, unless there is an index, which takes a second per million stored chunks.
  Outcome find_empty_bricks(int level) const override;

 private:
  struct Ranges {
    std::mutex mutex;
    std::unordered_map<std::uint64_t, BrickRange> known;
    std::vector<std::uint8_t> present;  ///< Empty: not listed.
  };

  std::shared_ptr<const StoredLevels> stored_;
  std::vector<std::unique_ptr<Ranges>> ranges_;  ///< One per level.
};

}  // namespace catena::field
