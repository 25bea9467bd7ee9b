// SPDX-License-Identifier: MIT
#include "haptics/servo/brick_pager.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <limits>
#include <mutex>
#include <thread>

#include "engine/base/clock.h"
#include "engine/base/memory_limit.h"
#include "engine/base/threads.h"
#include "engine/base/triple_buffer.h"
#include "engine/field/bricks/brick_cache.h"
#include "haptics/servo/brick_plan.h"

namespace catena::haptics {

namespace {

constexpr std::int64_t kPlanIntervalNs = 2'000'000;
constexpr std::int64_t kRestingPlanNs = 250'000'000;  // interval while the hand rests

/// Positions of a tick: the probe and the proxies of all links.
struct Posted {
  double t_s = 0;
  std::int32_t count = 0;
  std::array<Vec3, kMaxLinks + 1> positions{};
};

}  // namespace

struct BrickPager::Impl {
  // haptic thread and planning thread
  TripleBuffer<Posted> posted;
  TripleBuffer<const field::BrickSnapshot*> newest;
  std::atomic<std::uint64_t> used{0};

  std::mutex mutex;
  std::condition_variable changed;
  bool has_arrived = false, has_new_grids = false, stop = false;
  std::uint64_t plans = 0;  ///< number of plans made

  // planning thread, and set_observer() under `observing`
  std::mutex observing;
  Observer observe;
  std::deque<std::shared_ptr<const field::BrickSnapshot>> alive;
  std::uint64_t number = 0;
  Posted before, now, planned_for;
  std::array<Vec3, kMaxLinks + 1> velocities{};

  std::unique_ptr<field::BrickCache> cache;
  std::thread thread;

  bool take_positions(const Grids& grids);
  std::vector<field::BrickId> plan_all(const Grids& grids);
  void publish(std::vector<field::StoredBrick> bricks);
  void run();
  template <class Change>
  void notify(const Change& change) {
    {
      const std::scoped_lock lock(mutex);
      change();
    }
    changed.notify_all();
  }
};

/// Takes the newest positions and their velocities. Returns whether one has moved by more than a quarter of a voxel since the last plan.
bool BrickPager::Impl::take_positions(const Grids& grids) {
  if (!posted.acquire()) return false;
  before = now;
  now = posted.front();
  const double dt = now.t_s - before.t_s;
  double voxel = std::numeric_limits<double>::infinity();
  for (const auto& grid : grids) voxel = std::min(voxel, grid->mapping().min_voxel_edge());
  bool has_moved = now.count != planned_for.count;
  for (int i = 0; i < now.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    // a jump has no velocity
    const Vec3 velocity = dt > 0 && dt < 0.1 && before.count == now.count ? (now.positions[k] - before.positions[k]) / dt : Vec3(0.0);
    velocities[k] = is_finite(velocity) ? 0.5 * (velocities[k] + velocity) : Vec3(0.0);
    has_moved = has_moved || norm(now.positions[k] - planned_for.positions[k]) > 0.25 * voxel;
  }
  return has_moved;
}

/// Plans the bricks of all grids, taking turns, for the positions taken last.
std::vector<field::BrickId> BrickPager::Impl::plan_all(const Grids& grids) {
  planned_for = now;
  std::array<WatchedPosition, kMaxLinks + 1> positions;
  for (std::size_t k = 0; k < positions.size(); ++k) positions[k] = {now.positions[k], velocities[k]};
  std::vector<std::vector<field::BrickId>> of_grids;
  for (const auto& grid : grids)
    of_grids.push_back(
        plan_bricks(*grid, {positions.data(), static_cast<std::size_t>(now.count)}, {kNearVoxels, kLookAhead_s, cache->capacity(*grid)}));
  std::vector<field::BrickId> all;
  for (std::size_t i = 0, added = 1; added > 0; ++i) {
    added = 0;
    for (const auto& plan : of_grids)
      if (i < plan.size()) all.push_back(plan[i]), ++added;
  }
  return all;
}

/// Passes a snapshot to the observer, then to the haptic thread; frees those that it cannot use any more.
void BrickPager::Impl::publish(std::vector<field::StoredBrick> bricks) {
  const std::scoped_lock observed(observing);
  alive.push_back(std::make_shared<const field::BrickSnapshot>(++number, bricks));
  while (alive.size() > 1 && alive.front()->number() < used.load(std::memory_order_acquire)) alive.pop_front();
  if (observe) observe(*alive.back());
  newest.publish(alive.back().get());
}

/// Loop of the planning thread.
void BrickPager::Impl::run() {
  std::unique_lock lock(mutex);
  std::int64_t planned_ns = 0;
  while (!stop) {
    const bool has_bricks = std::exchange(has_arrived, false), has_grids = std::exchange(has_new_grids, false);
    lock.unlock();
    const std::int64_t since_ns = now_ns() - planned_ns;
    bool has_planned = false;
    if (has_grids || since_ns >= kPlanIntervalNs) {
      const Grids grids = cache->grids();
      has_planned = take_positions(grids) || has_grids || since_ns >= kRestingPlanNs;
      if (has_planned) {
        cache->set_wanted(plan_all(grids));
        planned_ns = now_ns();
      }
    }
    if (has_bricks || has_grids)
      if (auto bricks = cache->take_changes()) publish(std::move(*bricks));
    lock.lock();
    plans += has_planned;
    changed.notify_all();  // for wait_until_idle()
    changed.wait_for(lock, std::chrono::nanoseconds(kPlanIntervalNs), [&] { return stop || has_arrived || has_new_grids; });
  }
}

BrickPager::BrickPager(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

std::uint64_t BrickPager::default_bytes() { return std::clamp(available_memory() / 8, kMinBytes, kMaxBytes); }

Result<std::unique_ptr<BrickPager>> BrickPager::start(std::uint64_t max_bytes) {
  std::unique_ptr<BrickPager> pager(new BrickPager(std::make_unique<Impl>()));
  Impl* impl = pager->impl_.get();
  CATENA_TRY(impl->cache, field::BrickCache::start(max_bytes, [impl] { impl->notify([impl] { impl->has_arrived = true; }); }));
  CATENA_TRY(impl->thread, start_thread("the pager of bricks", [impl] { impl->run(); }));
  return pager;
}

BrickPager::~BrickPager() {
  impl_->notify([&] { impl_->stop = true; });
  if (impl_->thread.joinable()) impl_->thread.join();
  impl_->cache.reset();
}

void BrickPager::set_grids(const Grids& grids) {
  impl_->cache->set_grids(grids);
  impl_->notify([&] { impl_->has_new_grids = true; });
}

void BrickPager::set_observer(Observer observe) {
  const std::scoped_lock observed(impl_->observing);
  impl_->observe = std::move(observe);
  if (impl_->observe && !impl_->alive.empty()) impl_->observe(*impl_->alive.back());
}

bool BrickPager::wait_until_idle(double timeout_s) {
  std::unique_lock lock(impl_->mutex);
  const std::uint64_t plans = impl_->plans;
  return impl_->changed.wait_for(lock, std::chrono::duration<double>(timeout_s),
                                 [&] { return impl_->plans > plans + 1 && !impl_->has_arrived && impl_->cache->is_idle(); });
}

const field::BrickSnapshot* BrickPager::newest() noexcept {
  // that of the last tick stays alive: the tick compares both
  if (const field::BrickSnapshot* last = impl_->newest.front()) impl_->used.store(last->number(), std::memory_order_release);
  impl_->newest.acquire();
  return impl_->newest.front();
}

void BrickPager::put(const HapticState& state) noexcept {
  Posted& posted = impl_->posted.back();
  posted.t_s = state.t_s;
  posted.count = 1 + state.link_count;
  posted.positions[0] = state.probe;
  for (int i = 0; i < state.link_count; ++i)
    posted.positions[static_cast<std::size_t>(i) + 1] = state.links[static_cast<std::size_t>(i)].proxy;
  impl_->posted.publish();
}

}  // namespace catena::haptics
