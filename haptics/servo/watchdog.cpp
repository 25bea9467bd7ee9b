// SPDX-License-Identifier: MIT
#include "haptics/servo/watchdog.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/threads.h"
#include "haptics/servo/realtime.h"

namespace catena::haptics {

Watchdog::Watchdog(Device& device, double limit_s, std::atomic<std::uint64_t>& trips)
    : device_(device), limit_ns_(static_cast<std::int64_t>(1e9 * limit_s)), trips_(trips) {}

Result<std::unique_ptr<Watchdog>> Watchdog::make(Device& device, double limit_s, std::atomic<std::uint64_t>& trips) {
  auto watchdog = std::unique_ptr<Watchdog>(new Watchdog(device, limit_s, trips));
  CATENA_TRY(watchdog->thread_, start_thread("the servo's watchdog", [self = watchdog.get()] { self->watch(); }));
  return watchdog;
}

Watchdog::~Watchdog() {
  stop_.store(true, std::memory_order_release);
  int waits = kNotStarted;
  fifo_priority_.compare_exchange_strong(waits, 0);
  fifo_priority_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Watchdog::start(std::int64_t now_ns, int fifo_priority) noexcept {
  last_ns_.store(now_ns, std::memory_order_release);
  fifo_priority_.store(fifo_priority, std::memory_order_release);
  fifo_priority_.notify_all();
}

void Watchdog::report_stall() noexcept {
  if (claim_stall(last_ns_.load(std::memory_order_relaxed))) trips_.fetch_add(1, std::memory_order_relaxed);
  device_.stop();
}

void Watchdog::watch() {
  fifo_priority_.wait(kNotStarted, std::memory_order_acquire);
  const int fifo_priority = fifo_priority_.load(std::memory_order_acquire);
  std::vector<std::string> notes;  // already reported by the haptic thread
  // the watchdog gets a higher priority if permitted, and any core, so that a busy haptic thread cannot block it
  reset_cpu_affinity();
  if (fifo_priority > 0 && !acquire_fifo_priority(fifo_priority, notes)) acquire_fifo_priority(fifo_priority - 1, notes);
  const std::chrono::nanoseconds nap(std::clamp<std::int64_t>(limit_ns_ / 8, 500'000, 10'000'000));
  while (!stop_.load(std::memory_order_acquire)) {
    std::this_thread::sleep_for(nap);
    const std::int64_t last = last_ns_.load(std::memory_order_acquire);
    if (now_ns() - last <= limit_ns_ || !claim_stall(last)) continue;
    device_.stop();
    trips_.fetch_add(1, std::memory_order_relaxed);
    tripped_.store(true, std::memory_order_release);
  }
}

}  // namespace catena::haptics
