/// The grid of absolute deadlines t_n = first + n T that a paced servo wakes at, as plain arithmetic on nanoseconds.
///   A tick belongs to the newest deadline that has passed when it begins. Deadlines that get no tick are missed: at the begin of
///   every tick, ticks + missed = deadlines so far.
///   A tick's time is its deadline, or the moment at which it began if that is more than T/4 later: the velocity's dt is honest
///   after a miss too. It is late if its time is more than 2 T after the last tick's.
///   The next deadline is after the end of the tick and at least T/2 after its begin, so that dt never gets small.
///   There was a stall before a tick if more than `stall` passed from the end of the last tick to its beginning: the thread did not run.
///   Perhaps the whole program did not, with its watchdog (SIGSTOP).
/// Haptic thread.
#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>

namespace catena::haptics {

/// How a tick stands to the grid.
struct TickTiming {
  std::int64_t time_ns = 0;  ///< of the tick, since the first deadline
  std::int64_t missed = 0;   ///< deadlines between the last tick's and its own
  bool late = false;         ///< its time is more than two periods after the last tick's
  bool stalled = false;      ///< the thread did not run for longer than `stall`
};

/// The grid. One thread.
class DeadlineClock {
 public:
  static constexpr std::int64_t kNeverStalls = std::numeric_limits<std::int64_t>::max();  ///< As `stall_ns`: stalls are not looked for.

  /// A grid of this period from `first_ns` on, all of now_ns().
  DeadlineClock(std::int64_t period_ns, std::int64_t first_ns, std::int64_t stall_ns = kNeverStalls)
      : period_ns_(period_ns), first_ns_(first_ns), stall_ns_(stall_ns), last_end_ns_(first_ns) {}

  /// The deadline to sleep until, of now_ns().
  std::int64_t next_wake_ns() const noexcept { return first_ns_ + next_ * period_ns_; }

  /// A tick begins now.
  TickTiming begin_tick(std::int64_t now_ns) noexcept {
    const std::int64_t since = std::max<std::int64_t>(0, now_ns - first_ns_), deadline = std::max(next_, since / period_ns_);
    TickTiming beat;
    beat.missed = deadline - last_ - 1;
    beat.time_ns = deadline * period_ns_;
    if (since - beat.time_ns > period_ns_ / 4) beat.time_ns = since;
    beat.late = last_ >= 0 && beat.time_ns - last_time_ns_ > 2 * period_ns_;
    beat.stalled = now_ns - last_end_ns_ > stall_ns_;
    last_ = deadline;
    last_time_ns_ = beat.time_ns;
    return beat;
  }

  /// It ends now.
  void end_tick(std::int64_t now_ns) noexcept {
    const std::int64_t since = std::max(now_ns - first_ns_, last_time_ns_ + (period_ns_ - 1) / 2);
    next_ = std::max(last_, since / period_ns_) + 1;
    last_end_ns_ = now_ns;
  }

 private:
  std::int64_t period_ns_, first_ns_, stall_ns_, last_end_ns_;
  std::int64_t next_ = 0, last_ = -1, last_time_ns_ = 0;
};

}  // namespace catena::haptics
