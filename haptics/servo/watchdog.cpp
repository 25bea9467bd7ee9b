#include "haptics/servo/watchdog.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "engine/base/clock.h"
#include "haptics/servo/realtime.h"

namespace catena::haptics {

Watchdog::Watchdog(Device& device, double limit_s, int fifo_priority, std::atomic<std::uint64_t>& trips)
    : device_(device), limit_ns_(static_cast<std::int64_t>(1e9 * limit_s)), trips_(trips), last_ns_(now_ns()) {
  thread_ = std::thread([this, fifo_priority] { watch(fifo_priority); });
}

Watchdog::~Watchdog() {
  stop_.store(true, std::memory_order_release);
  thread_.join();
}

void Watchdog::watch(int fifo_priority) {
  std::vector<std::string> notes;  // the haptic thread has told them
  // a haptic thread that spins must not keep it from running: before it where that is permitted, and beside it
  leave_core();
  if (fifo_priority > 0 && !take_fifo(fifo_priority, notes)) take_fifo(fifo_priority - 1, notes);
  const std::chrono::nanoseconds nap(std::clamp<std::int64_t>(limit_ns_ / 8, 500'000, 10'000'000));
  std::int64_t stalled_since = -1;
  while (!stop_.load(std::memory_order_acquire)) {
    std::this_thread::sleep_for(nap);
    const std::int64_t last = last_ns_.load(std::memory_order_acquire);
    if (last == stalled_since || now_ns() - last <= limit_ns_) continue;
    stalled_since = last;
    device_.stop();
    trips_.fetch_add(1, std::memory_order_relaxed);
    tripped_.store(true, std::memory_order_release);
  }
}

}  // namespace catena::haptics
