// SPDX-License-Identifier: MIT
#include "engine/field/bricks/brick_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <iterator>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include "engine/base/clock.h"
#include "engine/base/console.h"
#include "engine/base/memory_limit.h"
#include "engine/base/threads.h"

namespace catena::field {

namespace {
constexpr std::int64_t kRetryNs = 1'000'000'000;  // time after which an unreadable brick is tried again
}

struct BrickCache::Impl {
  Impl(std::uint64_t bytes, std::function<void()> call) : max_bytes(bytes), reservation(bytes), on_change(std::move(call)) {}

  const std::uint64_t max_bytes;
  MemoryReservation reservation;
  const std::function<void()> on_change;

  mutable std::mutex mutex;
  std::condition_variable planned;
  Grids grids;
  std::vector<BrickId> wanted;
  std::deque<BrickId> to_read;  ///< those of `wanted` that are not in memory
  std::set<BrickId> reading;
  std::map<BrickId, std::shared_ptr<const Brick>> resident;
  std::map<BrickId, std::int64_t> unreadable;  ///< time of the last attempt
  bool has_changed = false, stop = false, has_complained = false;
  int read_count = 0;  ///< bricks whose reading was timed, and
  double read_ms = 0;  ///< the sum of their times
  std::vector<std::thread> threads;

  void read();
  void note_slow_reads(const std::string& name, std::int64_t duration_ns);
  void evict();
  std::shared_ptr<const PagedGrid> grid_of(const BrickId& id) const {
    for (const auto& grid : grids)
      if (grid->version() == id.grid) return grid;
    return nullptr;
  }
  bool needs_reading(const BrickId& id) const {
    if (resident.contains(id) || reading.contains(id)) return false;
    const auto failed = unreadable.find(id);
    return failed == unreadable.end() || now_ns() - failed->second > kRetryNs;
  }
};

/// Loop of a thread.
void BrickCache::Impl::read() {
  std::unique_lock lock(mutex);
  while (!stop) {
    if (to_read.empty()) {
      planned.wait(lock);
      continue;
    }
    const BrickId id = to_read.front();
    to_read.pop_front();
    const std::shared_ptr<const PagedGrid> grid = grid_of(id);
    if (grid == nullptr || !needs_reading(id)) continue;
    reading.insert(id);
    lock.unlock();
    const std::int64_t start_ns = now_ns();
    auto brick = grid->read(grid->brick_at(id.number));
    lock.lock();
    reading.erase(id);
    if (brick) {
      note_slow_reads(grid->name(), now_ns() - start_ns);
      unreadable.erase(id);
      resident[id] = std::move(*brick);
      has_changed = true;
    } else {
      unreadable[id] = now_ns();
      if (!std::exchange(has_complained, true)) print_message("note: " + brick.error().message + "; a coarser level is felt there");
    }
    lock.unlock();
    on_change();
    lock.lock();
  }
}

/// Prints a note once if bricks take long: chunks that are planes or columns, or a compression that decodes slowly. `mutex` is held.
void BrickCache::Impl::note_slow_reads(const std::string& name, std::int64_t duration_ns) {
  constexpr int kCounted = 16;
  constexpr double kSlowMs = 10;
  if (read_count >= kCounted) return;
  read_ms += 1e-6 * static_cast<double>(duration_ns);
  if (++read_count == kCounted && read_ms > kCounted * kSlowMs)
    print_message(
        fmt::format("note: {}: a brick takes {:.0f} ms to read, so the hand may feel a coarser level; catena import writes a "
                    ".zarr that is read faster",
                    name, read_ms / kCounted));
}

/// Removes bricks that are not wanted until the rest fits into memory. `mutex` is held.
void BrickCache::Impl::evict() {
  std::uint64_t bytes = 0;
  for (const auto& [id, brick] : resident) bytes += brick->bytes();
  if (bytes <= max_bytes) return;
  const std::set<BrickId> keep(wanted.begin(), wanted.end());
  for (auto at = resident.begin(); at != resident.end() && bytes > max_bytes;) {
    const bool leaves = !keep.contains(at->first);
    if (leaves) bytes -= at->second->bytes();
    at = leaves ? resident.erase(at) : std::next(at);
  }
}

BrickCache::BrickCache(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Result<std::unique_ptr<BrickCache>> BrickCache::start(std::uint64_t max_bytes, std::function<void()> on_change) {
  std::unique_ptr<BrickCache> cache(new BrickCache(std::make_unique<Impl>(max_bytes, std::move(on_change))));
  Impl* impl = cache->impl_.get();
  for (int i = 0; i < kReaders; ++i) {
    CATENA_TRY(std::thread reader, start_thread("a reader of bricks", [impl] { impl->read(); }));
    impl->threads.push_back(std::move(reader));
  }
  return cache;
}

BrickCache::~BrickCache() {
  {
    const std::scoped_lock lock(impl_->mutex);
    impl_->stop = true;
  }
  impl_->planned.notify_all();
  for (std::thread& thread : impl_->threads) thread.join();
}

void BrickCache::set_grids(const Grids& grids) {
  const std::scoped_lock lock(impl_->mutex);
  if (grids == impl_->grids) return;
  impl_->grids = grids;
  const auto is_left = [&](const auto& entry) { return impl_->grid_of(entry.first) == nullptr; };
  if (std::erase_if(impl_->resident, is_left) > 0) impl_->has_changed = true;
  std::erase_if(impl_->unreadable, is_left);
}

BrickCache::Grids BrickCache::grids() const {
  const std::scoped_lock lock(impl_->mutex);
  return impl_->grids;
}

std::size_t BrickCache::capacity(const PagedGrid& grid) const {
  const std::scoped_lock lock(impl_->mutex);
  const std::uint64_t brick_bytes = std::uint64_t{kBrickEdge} * kBrickEdge * kBrickEdge * grid.source().type().bytes;
  return static_cast<std::size_t>(impl_->max_bytes / std::max<std::size_t>(1, impl_->grids.size()) / brick_bytes);
}

void BrickCache::set_wanted(std::vector<BrickId> wanted) {
  const std::scoped_lock lock(impl_->mutex);
  impl_->wanted = std::move(wanted);
  impl_->to_read.clear();
  std::ranges::copy_if(impl_->wanted, std::back_inserter(impl_->to_read), [&](const BrickId& id) { return impl_->needs_reading(id); });
  if (!impl_->to_read.empty()) impl_->planned.notify_all();
}

std::optional<std::vector<StoredBrick>> BrickCache::take_changes() {
  const std::scoped_lock lock(impl_->mutex);
  if (!std::exchange(impl_->has_changed, false)) return std::nullopt;
  impl_->evict();
  std::vector<StoredBrick> bricks;
  bricks.reserve(impl_->resident.size());
  for (const auto& [id, brick] : impl_->resident) bricks.push_back({id, brick});
  return bricks;
}

bool BrickCache::is_idle() const {
  const std::scoped_lock lock(impl_->mutex);
  return impl_->reading.empty() && !impl_->has_changed &&
         std::ranges::none_of(impl_->wanted, [&](const BrickId& id) { return impl_->needs_reading(id); });
}

}  // namespace catena::field
