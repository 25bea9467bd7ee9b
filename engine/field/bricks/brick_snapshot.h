// SPDX-License-Identifier: MIT
/// Bricks in memory. A snapshot is the set of bricks that a haptic tick, or a picture, can use at one moment: immutable, so that nothing
/// changes or vanishes while it is read; bricks are shared between snapshots.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "engine/field/bricks/brick_source.h"

namespace catena::field {

/// A brick of the finest level of a paged grid (paged_grid.h). Ordered by grid, then by number.
struct BrickId {
  std::uint64_t grid = 0;    ///< PagedGrid::version()
  std::uint64_t number = 0;  ///< Number of the brick in its level, x fastest (brick_counts()).
  auto operator<=>(const BrickId&) const = default;
};

/// Voxels of a brick, in the stored number type. Immutable; any thread.
class Brick {
 public:
  /// Takes `values`, x fastest: exactly the voxels of `size`.
  Brick(const NumberType& type, const Index3& size, std::vector<std::byte> values) : type_(type), size_(size), values_(std::move(values)) {}
  /// Returns the value of a voxel, by its position in the brick, rounded to a 32-bit float as when a whole grid is loaded.
  float value(int x, int y, int z) const noexcept;
  /// Returns the number type of the voxels.
  const NumberType& type() const { return type_; }
  /// Returns the number of voxels along each axis.
  const Index3& size() const { return size_; }
  /// Returns the voxels, x fastest.
  std::span<const std::byte> values() const { return values_; }
  /// Returns the memory of the values, bytes.
  std::size_t bytes() const { return values_.size(); }

 private:
  NumberType type_;
  Index3 size_;
  std::vector<std::byte> values_;
};

/// A brick with its values.
struct StoredBrick {
  BrickId id;
  std::shared_ptr<const Brick> values;
};

/// Bricks in memory at one moment. Immutable; any thread.
class BrickSnapshot {
 public:
  /// `number`: number of the snapshot, increasing in a session. No brick occurs twice.
  BrickSnapshot(std::uint64_t number, std::span<const StoredBrick> bricks);
  /// Returns the number of the snapshot.
  std::uint64_t number() const noexcept { return number_; }
  /// Returns the bricks.
  std::span<const StoredBrick> bricks() const noexcept { return bricks_; }
  /// Returns a brick; null: it is not in memory. Bounded time; no allocation or lock.
  const Brick* find(const BrickId& id) const noexcept;

 private:
  struct Slot {
    BrickId id;
    const Brick* values = nullptr;
  };
  static std::size_t hash(const BrickId& id) noexcept;

  std::uint64_t number_;
  std::vector<StoredBrick> bricks_;
  std::vector<Slot> slots_;       ///< Hash table with linear probing; the size is a power of two.
  std::size_t max_distance_ = 0;  ///< Longest distance of a brick from the slot of its hash.
};

}  // namespace catena::field
