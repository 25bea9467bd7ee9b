/// Sees that the haptic thread has stopped finishing ticks, and takes the force away without its help: a thread that looks at one
/// time stamp every few milliseconds.
///   now - (end of the last tick) > limit  ->  device.stop(), then the flag; once for a stall
/// The haptic thread takes the flag in the tick that runs next: zero force (Condition::watchdog); the tick after it resumes the device
/// and the guard ramps the force in. device.stop() comes before the flag, so that no stop is left over after a resume.
#pragma once
#include <atomic>
#include <cstdint>
#include <thread>

#include "haptics/device/device.h"

namespace catena::haptics {

class Watchdog {
 public:
  /// Watches from now on, and counts the stalls in `trips`. `fifo_priority` > 0: at that fixed priority or the one below, if permitted.
  Watchdog(Device& device, double limit_s, int fifo_priority, std::atomic<std::uint64_t>& trips);
  ~Watchdog();  ///< joins; at most a few milliseconds
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  // haptic thread
  void tick_ended(std::int64_t now_ns) noexcept { last_ns_.store(now_ns, std::memory_order_release); }
  bool take_trip() noexcept { return tripped_.load(std::memory_order_relaxed) && tripped_.exchange(false, std::memory_order_acq_rel); }

 private:
  void watch(int fifo_priority);

  static_assert(std::atomic<std::int64_t>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);
  Device& device_;
  std::int64_t limit_ns_;
  std::atomic<std::uint64_t>& trips_;
  std::atomic<std::int64_t> last_ns_;
  std::atomic<bool> tripped_{false}, stop_{false};
  std::thread thread_;
};

}  // namespace catena::haptics
