// SPDX-License-Identifier: MIT
#include "engine/io/field_cache.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <list>
#include <mutex>
#include <thread>

#include "engine/base/memory_limit.h"
#include "engine/base/threads.h"

namespace catena::field {
namespace {

class Keeper {
 public:
  ~Keeper() { forget(); }

  Result<AnyField> load(const LoadRequest& request) {
    std::unique_lock lock(mutex_);
    done_.wait(lock, [&] { return !loading_ || !(*loading_ == request); });
    if (const AnyField* field = find(request)) return *field;
    lock.unlock();
    auto loaded = field::load(request);
    lock.lock();
    if (loaded) keep(request, *loaded);
    return loaded;
  }

  void add(const LoadRequest& request, const AnyField& field) {
    const std::scoped_lock lock(mutex_);
    keep(request, field);
  }

  bool has(const LoadRequest& request) {
    const std::scoped_lock lock(mutex_);
    return std::any_of(kept_.begin(), kept_.end(), [&](const Kept& entry) { return entry.request == request; });
  }

  void ahead(std::vector<LoadRequest> requests) {
    const std::scoped_lock lock(mutex_);
    waiting_.assign(std::make_move_iterator(requests.begin()), std::make_move_iterator(requests.end()));
    if (waiting_.empty() || runs_) return;
    if (thread_.joinable()) thread_.join();
    auto started = start_thread("loading ahead", [this] { work(); });
    if (!started) return;  // nothing is loaded ahead
    thread_ = std::move(*started);
    runs_ = true;
  }

  void forget() {
    {
      const std::scoped_lock lock(mutex_);
      waiting_.clear();
    }
    if (thread_.joinable()) thread_.join();
    const std::scoped_lock lock(mutex_);
    kept_.clear();
  }

 private:
  struct Kept {
    LoadRequest request;
    AnyField field;
    std::uint64_t bytes;
  };

  /// Finds a cached field and makes it the most recently used one.
  const AnyField* find(const LoadRequest& request) {
    const auto it = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& entry) { return entry.request == request; });
    if (it == kept_.end()) return nullptr;
    kept_.splice(kept_.end(), kept_, it);
    return &kept_.back().field;
  }

  void keep(const LoadRequest& request, const AnyField& field) {
    if (find(request) != nullptr) return;
    kept_.push_back({request, field, field.get()->bytes()});
    std::uint64_t all = 0;
    for (const Kept& entry : kept_) all += entry.bytes;
    constexpr std::uint64_t kShare = 4;
    const std::uint64_t room = available_memory() / kShare;
    while (kept_.size() > 1 && all > room) {
      all -= kept_.front().bytes;
      kept_.pop_front();
    }
  }

  void work() {
    for (;;) {
      std::unique_lock lock(mutex_);
      while (!waiting_.empty() && find(waiting_.front()) != nullptr) waiting_.pop_front();
      if (waiting_.empty()) {
        runs_ = false;
        return;
      }
      loading_ = waiting_.front();
      waiting_.pop_front();
      const LoadRequest request = *loading_;
      lock.unlock();
      auto loaded = field::load(request);
      lock.lock();
      if (loaded) keep(request, *loaded);
      loading_.reset();
      done_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable done_;
  std::list<Kept> kept_;  ///< oldest first
  std::deque<LoadRequest> waiting_;
  std::optional<LoadRequest> loading_;  ///< being loaded ahead now
  bool runs_ = false;                   ///< whether the thread has not yet announced its end
  std::thread thread_;
};

Keeper& keeper() {
  static Keeper one;
  return one;
}

}  // namespace

Result<AnyField> load_cached(const LoadRequest& request) { return keeper().load(request); }
void prefetch(std::vector<LoadRequest> requests) { keeper().ahead(std::move(requests)); }
bool is_cached(const LoadRequest& request) { return keeper().has(request); }
void add_to_cache(const LoadRequest& request, const AnyField& field) { keeper().add(request, field); }
void clear_cache() { keeper().forget(); }

}  // namespace catena::field
