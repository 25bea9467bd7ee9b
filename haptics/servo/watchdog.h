// SPDX-License-Identifier: MIT
/// Watchdog of the servo: detects that the haptic thread does not finish ticks, and cuts the force without its help. A thread reads one
/// time stamp every few milliseconds.
///   now - (end of the last tick) > limit  ->  device.stop(), then the flag is set; one time per stall
/// The haptic thread takes the flag in the next tick that runs: zero force (TickCondition::watchdog). The tick after it resumes the device,
/// and the force limiter ramps the force in. device.stop() precedes the flag, so that no stop can follow a resume.
/// If the whole program was stopped (SIGSTOP), the haptic thread may run before the watchdog: it detects the gap by itself
/// (deadline_clock.h) and reports it. A stall is counted one time, whichever thread detects it.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

#include "engine/base/result.h"
#include "haptics/device/device.h"

namespace catena::haptics {

/// Watchdog thread. The device and `trips` must outlive it.
class Watchdog {
 public:
  /// Creates the thread, which waits for start() and counts stalls in `trips`. An Error if no thread can be created.
  static Result<std::unique_ptr<Watchdog>> make(Device& device, double limit_s, std::atomic<std::uint64_t>& trips);
  /// Joins the thread; takes at most a few milliseconds.
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Returns the time without a finished tick that counts as a stall, nanoseconds.
  std::int64_t limit_ns() const { return limit_ns_; }

  // haptic thread
  /// Starts to watch. `fifo_priority` > 0: fixed priority of the watchdog's thread, or the one below it, if permitted.
  void start(std::int64_t now_ns, int fifo_priority) noexcept;
  /// Stores the end of a tick.
  void tick_ended(std::int64_t now_ns) noexcept { last_ns_.store(now_ns, std::memory_order_release); }
  /// Returns whether the watchdog has stopped the device since the last call, and clears the flag.
  bool consume_trip() noexcept { return tripped_.load(std::memory_order_relaxed) && tripped_.exchange(false, std::memory_order_acq_rel); }
  /// Reports that the haptic thread itself did not run, or did not finish a tick, for longer than the limit. Stops the device.
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
  std::atomic<std::int64_t> claimed_ns_{-1};  ///< stall that has been counted, identified by the end of the tick before it
  std::atomic<int> fifo_priority_{kNotStarted};
  std::atomic<bool> tripped_{false}, stop_{false};
  static constexpr int kNotStarted = -1;
  std::thread thread_;
};

}  // namespace catena::haptics
