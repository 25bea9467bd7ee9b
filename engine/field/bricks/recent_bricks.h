// SPDX-License-Identifier: MIT
/// Bricks of a source in memory, shared by all that read it: the hand, the rays, calculations that wait for their bricks. A brick that
/// somebody still uses, or that was read lately, is not read again; threads that want the same brick at the same time read it once.
/// Any thread.
#pragma once
#include <condition_variable>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <set>
#include <unordered_map>

#include "engine/base/memory_limit.h"
#include "engine/base/result.h"
#include "engine/field/bricks/brick_snapshot.h"
#include "engine/field/bricks/brick_source.h"

namespace catena::field {

/// A source with the bricks of it that are in memory.
class RecentBricks {
 public:
  /// Bricks that nobody uses are retained up to this size, bytes, or an eighth of the memory that is available at first.
  static constexpr std::uint64_t kMaxRetainedBytes = std::uint64_t{128} << 20;

  explicit RecentBricks(std::shared_ptr<const BrickSource> source);
  /// Returns the source.
  const BrickSource& source() const { return *source_; }
  /// Returns a brick of a level. Blocks while it is read. The Error is a complete message.
  Result<std::shared_ptr<const Brick>> read(int level, const Index3& brick);

 private:
  struct Entry {
    std::weak_ptr<const Brick> brick;
    std::list<std::uint64_t>::iterator age;  ///< Position in `order_`, if retained.
    std::shared_ptr<const Brick> retained;   ///< Null: not retained.
  };
  void retain(std::uint64_t key, const std::shared_ptr<const Brick>& brick);

  const std::shared_ptr<const BrickSource> source_;
  const std::uint64_t max_bytes_;
  const MemoryReservation reservation_;
  std::mutex mutex_;
  std::condition_variable read_;
  std::unordered_map<std::uint64_t, Entry> entries_;
  std::set<std::uint64_t> reading_;
  std::list<std::uint64_t> order_;  ///< Retained bricks, the latest first.
  std::uint64_t bytes_ = 0;         ///< Memory of the retained bricks.
};

}  // namespace catena::field
