// SPDX-License-Identifier: MIT
/// Brings the bricks of paged grids (engine/field/bricks/paged_grid.h) into memory before the hand needs them. The haptic thread never
/// waits for it: it posts its positions, and samples the newest snapshot of the bricks in a cache (engine/field/bricks/brick_cache.h).
///   order   bricks within kNearVoxels of where probe and proxies are, then of where they will be in the next kLookAhead_s at their present
///           velocity, the earliest first; then those farther around, as many as the memory holds (brick_plan.h)
/// Threads: the haptic thread calls newest() and put(), the frame thread the rest; a planning thread makes plans and snapshots. A snapshot
/// lives until the haptic thread has run a tick with a newer one.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/field/bricks/paged_grid.h"
#include "haptics/chain/tick.h"

namespace catena::haptics {

/// Loads bricks around the hand. Threads: see the file comment.
class BrickPager {
 public:
  static constexpr int kLoaders = 4;                                   ///< threads that read bricks
  static constexpr double kNearVoxels = 8;                             ///< margin around positions that the next ticks may sample
  static constexpr double kLookAhead_s = 0.4;                          ///< time in which a reader is expected to answer
  static constexpr std::uint64_t kMinBytes = std::uint64_t{64} << 20;  ///< memory of the bricks, at least
  static constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 30;   ///< and at most

  using Grids = std::vector<std::shared_ptr<const field::PagedGrid>>;

  /// Starts the threads. `max_bytes`: memory of the bricks. An Error if a thread cannot be created.
  static Result<std::unique_ptr<BrickPager>> start(std::uint64_t max_bytes);
  /// Returns the memory for bricks that the memory budget allows: an eighth of it, within the limits above.
  static std::uint64_t default_bytes();
  ~BrickPager();
  BrickPager(const BrickPager&) = delete;
  BrickPager& operator=(const BrickPager&) = delete;

  // frame thread
  /// Sets the grids; bricks of others leave.
  void set_grids(const Grids& grids);
  /// Calls `observe` with every further snapshot before the haptic thread can see it, and now with the newest one. On the planning thread;
  /// empty: none. When the call returns, no call of the one before is running.
  using Observer = std::function<void(const field::BrickSnapshot&)>;
  void set_observer(Observer observe);
  /// Waits until the bricks that the last posted positions need have been read, or cannot be. For tests and the start of a session.
  bool wait_until_idle(double timeout_s);

  // haptic thread
  /// Returns the newest snapshot; null: none yet. It is valid until the call after the next.
  const field::BrickSnapshot* newest() noexcept;
  /// Posts the positions of a tick.
  void put(const HapticState& state) noexcept;

 private:
  struct Impl;
  explicit BrickPager(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace catena::haptics
