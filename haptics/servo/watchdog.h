/// Sees that the haptic thread has stopped finishing ticks, and takes the force away without its help: a thread that looks at one
/// time stamp every few milliseconds.
///   now - (end of the last tick) > limit  ->  device.stop(), then the flag; once for a stall
/// The haptic thread takes the flag in the tick that runs next: zero force (TickCondition::watchdog); the tick after it resumes the device
/// and the guard ramps the force in. device.stop() comes before the flag, so that no stop is left over after a resume.
/// Where the whole program stood still (SIGSTOP), the haptic thread may be the first to run again: it sees the gap by itself (pace.h)
/// and says so; the stall counts once, whoever saw it.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

#include "engine/base/result.h"
#include "haptics/device/device.h"

namespace catena::haptics {

class Watchdog {
 public:
  /// A thread that waits for begin(); it counts the stalls in `trips`.
  static Result<std::unique_ptr<Watchdog>> make(Device& device, double limit_s, std::atomic<std::uint64_t>& trips);
  ~Watchdog();  ///< joins; at most a few milliseconds
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  std::int64_t limit_ns() const { return limit_ns_; }

  // haptic thread
  /// Watches from now on. `fifo_priority` > 0: at that fixed priority or the one below, if permitted.
  void start(std::int64_t now_ns, int fifo_priority) noexcept;
  void tick_ended(std::int64_t now_ns) noexcept { last_ns_.store(now_ns, std::memory_order_release); }
  bool consume_trip() noexcept { return tripped_.load(std::memory_order_relaxed) && tripped_.exchange(false, std::memory_order_acq_rel); }
  /// This thread has not run for longer than the limit: the device is stopped when this returns.
  void report_stall() noexcept;

 private:
  Watchdog(Device& device, double limit_s, std::atomic<std::uint64_t>& trips);
  void watch();
  bool claim_stall(std::int64_t last_ns) noexcept { return claimed_ns_.exchange(last_ns, std::memory_order_acq_rel) != last_ns; }

  static_assert(std::atomic<std::int64_t>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);
  Device& device_;
  std::int64_t limit_ns_;
  std::atomic<std::uint64_t>& trips_;
  std::atomic<std::int64_t> last_ns_{0};
  std::atomic<std::int64_t> claimed_ns_{-1};  ///< the stall that was acted upon: the end of the tick before it
  std::atomic<int> fifo_priority_{kNotStarted};
  std::atomic<bool> tripped_{false}, stop_{false};
  static constexpr int kNotStarted = -1;
  std::thread thread_;
};

}  // namespace catena::haptics
