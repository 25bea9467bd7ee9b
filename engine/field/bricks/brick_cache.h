// SPDX-License-Identifier: MIT
/// Cache of bricks of paged grids: threads read those that are wanted, the most urgent first, into a fixed amount of memory. What is not
/// wanted leaves when the memory is needed. A brick that cannot be read is tried again after a second.
/// Any thread may call the functions.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "engine/base/result.h"
#include "engine/field/bricks/paged_grid.h"

namespace catena::field {

/// Bricks in memory, and the threads that read them.
class BrickCache {
 public:
  static constexpr int kReaders = 4;  ///< threads that read bricks
  using Grids = std::vector<std::shared_ptr<const PagedGrid>>;

  /// Starts the threads. `max_bytes`: memory of the bricks. `on_change` is called by these threads when a brick has been read. An Error if
  /// a thread cannot be created.
  static Result<std::unique_ptr<BrickCache>> start(std::uint64_t max_bytes, std::function<void()> on_change);
  ~BrickCache();
  BrickCache(const BrickCache&) = delete;
  BrickCache& operator=(const BrickCache&) = delete;

  /// Sets the grids; bricks of others leave.
  void set_grids(const Grids& grids);
  /// Returns the grids.
  Grids grids() const;
  /// Returns the number of bricks of a grid that its share of the memory holds.
  std::size_t capacity(const PagedGrid& grid) const;
  /// Sets the bricks that are wanted, the most urgent first; at most as many as fit.
  void set_wanted(std::vector<BrickId> wanted);
  /// Returns all bricks in memory, ordered, if they have changed since the last call.
  std::optional<std::vector<StoredBrick>> take_changes();
  /// Returns whether all wanted bricks are in memory or cannot be read.
  bool is_idle() const;

 private:
  struct Impl;
  explicit BrickCache(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace catena::field
