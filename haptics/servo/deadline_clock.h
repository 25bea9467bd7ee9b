// SPDX-License-Identifier: MIT
/// Deadline clock: the grid of absolute deadlines t_n = first + n T at which a paced servo wakes, as plain arithmetic on nanoseconds.
///   A tick belongs to the newest deadline that has passed when it starts. Deadlines without a tick are missed: at the start of every tick,
///   ticks + missed = deadlines so far.
///   The time of a tick is its deadline, or the moment at which it started if that is more than T/4 later, so that the dt of the
///   velocity is correct after a miss too. The tick is late if its time is more than 2 T after that of the last tick.
///   The next deadline is after the end of the tick and about T/2 or more after the time of the tick, so that dt never gets small.
///   A tick was stalled if more than `stall_ns` passed between the end of the last tick and its start: the thread did not run. Possibly
///   the whole program did not run, including its watchdog (SIGSTOP).
/// Haptic thread.
#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>

namespace catena::haptics {

/// Timing of a tick relative to the deadlines.
struct TickTiming {
  std::int64_t time_ns = 0;  ///< time of the tick since the first deadline, nanoseconds
  std::int64_t missed = 0;   ///< number of deadlines between that of the last tick and its own
  bool late = false;         ///< the time of the tick is more than two periods after that of the last tick
  bool stalled = false;      ///< the thread did not run for longer than `stall_ns` before the tick
};

/// Deadline clock. One thread.
class DeadlineClock {
 public:
  /// Value of `stall_ns` that disables the detection of stalls.
  static constexpr std::int64_t kNeverStalls = std::numeric_limits<std::int64_t>::max();

  /// Creates a grid of this period that starts at `first_ns`; times are those of now_ns(), nanoseconds.
  DeadlineClock(std::int64_t period_ns, std::int64_t first_ns, std::int64_t stall_ns = kNeverStalls)
      : period_ns_(period_ns), first_ns_(first_ns), stall_ns_(stall_ns), last_end_ns_(first_ns) {}

  /// Returns the deadline until which to sleep, on the clock of now_ns().
  std::int64_t next_wake_ns() const noexcept { return first_ns_ + next_ * period_ns_; }

  /// Starts a tick at `now_ns`; returns its timing.
  TickTiming begin_tick(std::int64_t now_ns) noexcept {
    const std::int64_t elapsed_ns = std::max<std::int64_t>(0, now_ns - first_ns_), deadline = std::max(next_, elapsed_ns / period_ns_);
    TickTiming timing;
    timing.missed = deadline - last_ - 1;
    timing.time_ns = deadline * period_ns_;
    if (elapsed_ns - timing.time_ns > period_ns_ / 4) timing.time_ns = elapsed_ns;
    timing.late = last_ >= 0 && timing.time_ns - last_time_ns_ > 2 * period_ns_;
    timing.stalled = now_ns - last_end_ns_ > stall_ns_;
    last_ = deadline;
    last_time_ns_ = timing.time_ns;
    return timing;
  }

  /// Ends the tick at `now_ns`.
  void end_tick(std::int64_t now_ns) noexcept {
    const std::int64_t elapsed_ns = std::max(now_ns - first_ns_, last_time_ns_ + (period_ns_ - 1) / 2);
    next_ = std::max(last_, elapsed_ns / period_ns_) + 1;
    last_end_ns_ = now_ns;
  }

 private:
  std::int64_t period_ns_, first_ns_, stall_ns_, last_end_ns_;
  std::int64_t next_ = 0, last_ = -1, last_time_ns_ = 0;
};

}  // namespace catena::haptics
