// SPDX-License-Identifier: MIT
#include "engine/field/bricks/recent_bricks.h"

#include <algorithm>
#include <vector>

namespace catena::field {
namespace {

constexpr int kLevelShift = 56;                  // bits of a key below the level
constexpr std::size_t kMaxForgotten = 1u << 16;  // entries of bricks that nobody uses any longer, before they are removed

}  // namespace

RecentBricks::RecentBricks(std::shared_ptr<const BrickSource> source)
    : source_(std::move(source)), max_bytes_(std::min(kMaxRetainedBytes, available_memory() / 8)), reservation_(max_bytes_) {}

Result<std::shared_ptr<const Brick>> RecentBricks::read(int level, const Index3& brick) {
  const BrickLevel& at = source_->levels()[static_cast<std::size_t>(level)];
  const std::uint64_t key = static_cast<std::uint64_t>(level) << kLevelShift | brick_number(brick_counts(at), brick);
  std::unique_lock lock(mutex_);
  read_.wait(lock, [&] { return !reading_.contains(key); });
  if (const auto found = entries_.find(key); found != entries_.end()) {
    if (std::shared_ptr<const Brick> known = found->second.brick.lock()) {
      retain(key, known);
      return known;
    }
  }
  reading_.insert(key);
  lock.unlock();
  const Index3 size = brick_size(at, brick);
  const std::size_t voxels = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
  std::vector<std::byte> values(voxels * source_->type().bytes);
  const Outcome done = source_->read(level, brick, values);
  lock.lock();
  reading_.erase(key);
  read_.notify_all();
  if (!done) return done.error();
  auto made = std::make_shared<const Brick>(source_->type(), size, std::move(values));
  retain(key, made);
  return std::shared_ptr<const Brick>(std::move(made));
}

/// Makes a brick the latest, and drops the oldest ones. `mutex_` is held.
void RecentBricks::retain(std::uint64_t key, const std::shared_ptr<const Brick>& brick) {
  if (entries_.size() > kMaxForgotten) std::erase_if(entries_, [](const auto& entry) { return entry.second.brick.expired(); });
  Entry& entry = entries_[key];
  if (entry.retained) {
    order_.splice(order_.begin(), order_, entry.age);
  } else {
    order_.push_front(key);
    bytes_ += brick->bytes();
  }
  entry = {brick, order_.begin(), brick};
  while (bytes_ > max_bytes_ && !order_.empty()) {
    Entry& oldest = entries_[order_.back()];
    bytes_ -= oldest.retained->bytes();
    oldest.retained.reset();
    order_.pop_back();
  }
}

}  // namespace catena::field
