// SPDX-License-Identifier: MIT
#include "render/passes/slab_cache.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "engine/base/console.h"
#include "engine/base/threads.h"

namespace catena::render {
namespace {

constexpr std::size_t kMaxSlabs = 6;  // three planes of orthogonal views, and three others

/// A plane through a grid.
struct SlabPlane {
  std::shared_ptr<const field::PagedGrid> grid;
  Vec3 point{0.0}, normal{0.0};
  bool operator==(const SlabPlane&) const = default;
};

struct CachedSlab {
  SlabPlane plane;
  std::shared_ptr<const field::ScalarGrid> slab;
  bool is_read = false, is_new = false;  ///< reading has ended; get() has not returned it yet
};

}  // namespace

struct SlabCache::Impl {
  mutable std::mutex mutex;
  std::condition_variable changed;
  std::vector<CachedSlab> slabs;  ///< the plane requested last is the last one
  bool stop = false, has_complained = false;
  std::thread thread;

  ~Impl() {
    {
      const std::scoped_lock lock(mutex);
      stop = true;
    }
    changed.notify_all();
    if (thread.joinable()) thread.join();
  }

  CachedSlab* find(const SlabPlane& plane) {
    const auto at = std::ranges::find(slabs, plane, &CachedSlab::plane);
    return at == slabs.end() ? nullptr : &*at;
  }

  /// Loop of the thread: reads the plane that was requested last.
  void read() {
    std::unique_lock lock(mutex);
    const auto next = [&] { return std::ranges::find(slabs.rbegin(), slabs.rend(), false, &CachedSlab::is_read); };
    for (;;) {
      changed.wait(lock, [&] { return stop || next() != slabs.rend(); });
      if (stop) return;
      const SlabPlane plane = next()->plane;
      lock.unlock();
      const auto is_outdated = [&] {
        const std::scoped_lock look(mutex);
        return stop || find(plane) == nullptr;
      };
      auto made = field::make_slab(*plane.grid, plane.point, plane.normal, is_outdated);
      lock.lock();
      if (!made && !std::exchange(has_complained, true))
        print_message("note: " + made.error().message + "; a coarser level is shown there");
      if (CachedSlab* entry = find(plane); entry != nullptr && !stop) {
        entry->is_read = true;
        entry->slab = made ? *made : nullptr;
        entry->is_new = entry->slab != nullptr;
      }
      changed.notify_all();
    }
  }
};

SlabCache::SlabCache() = default;
SlabCache::~SlabCache() = default;
SlabCache::SlabCache(SlabCache&&) noexcept = default;
SlabCache& SlabCache::operator=(SlabCache&&) noexcept = default;

Result<std::shared_ptr<const field::ScalarGrid>> SlabCache::get(const std::shared_ptr<const field::PagedGrid>& grid, const Vec3& point,
                                                                const Vec3& normal, bool waits) {
  if (!impl_) {
    auto impl = std::make_unique<Impl>();
    CATENA_TRY(impl->thread, start_thread("a reader of slices", [raw = impl.get()] { raw->read(); }));
    impl_ = std::move(impl);
  }
  std::unique_lock lock(impl_->mutex);
  const SlabPlane plane{grid, point, normal};
  CachedSlab entry{plane, nullptr};
  if (CachedSlab* known = impl_->find(plane)) {
    entry = *known;
    impl_->slabs.erase(impl_->slabs.begin() + (known - impl_->slabs.data()));
  }
  entry.is_new = false;
  impl_->slabs.push_back(entry);
  if (impl_->slabs.size() > kMaxSlabs) impl_->slabs.erase(impl_->slabs.begin());
  impl_->changed.notify_all();
  if (waits) impl_->changed.wait(lock, [&] { return impl_->slabs.back().is_read; });
  impl_->slabs.back().is_new = false;
  return impl_->slabs.back().slab;
}

bool SlabCache::has_arrived() const {
  if (!impl_) return false;
  const std::scoped_lock lock(impl_->mutex);
  return std::ranges::any_of(impl_->slabs, &CachedSlab::is_new);
}

}  // namespace catena::render
