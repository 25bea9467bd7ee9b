// SPDX-License-Identifier: MIT
/// Statistics of a servo: histograms of durations and counters. Fixed size, no allocation, readable while they are being filled.
/// Buckets of a histogram:
///   below 128 ns: one bucket per nanosecond;  above: 128 buckets per octave, each at most 1/128 of its lower bound wide, up to 2^40 ns
/// A quantile is the middle of its bucket: the error is at most 1/256 (0.4 %). The maximum is exact.
/// One writer (the haptic thread), any number of readers; all relaxed atomics, wait-free.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/export.h"
#include "haptics/servo/realtime.h"

namespace catena::haptics {

/// Summary of a histogram, microseconds. The q-quantile is defined as in engine/base/numbers.h.
struct HistogramSummary {
  std::uint64_t count = 0;                                 ///< number of values
  double p50_us = 0, p99_us = 0, p999_us = 0, max_us = 0;  ///< quantiles and maximum
  /// Bin of a plot: 8 bins per octave; empty ones are left out.
  struct Bin {
    double from_us;       ///< lower bound of the bin, microseconds
    std::uint64_t count;  ///< number of values in the bin
  };
  std::vector<Bin> bins = {};  ///< non-empty bins in increasing order
};

/// Histogram of durations. One writer, any number of readers.
class CATENA_EXPORT Histogram {
 public:
  /// Adds a duration; a negative one counts as 0. Writer's thread.
  void add(std::int64_t ns) noexcept;
  /// Returns the summary of the values so far. Any thread but the writer's.
  HistogramSummary summarize() const;

 private:
  static constexpr int kSubBits = 7, kTopBit = 40;
  static constexpr std::uint64_t kSub = std::uint64_t{1} << kSubBits;
  static constexpr std::size_t kBuckets = kSub * (kTopBit - kSubBits + 1);
  static std::size_t bucket(std::uint64_t ns) noexcept;
  static double first_ns(std::size_t bucket);
  static double middle_ns(std::size_t bucket);

  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
  std::array<std::atomic<std::uint64_t>, kBuckets> counts_{};
  std::atomic<std::uint64_t> max_ns_{0};
};

/// Counters of a running servo. Written by the haptic thread (watchdog_trips: by the watchdog), read by any thread: relaxed, lock-free.
struct ServoCounters {
  Histogram period;   ///< time between the starts of two ticks
  Histogram compute;  ///< duration of the tick alone
  Histogram device;   ///< duration of reading and writing the device
  std::atomic<std::uint64_t> ticks{0}, missed_deadlines{0}, late_ticks{0}, lost_ticks{0}, watchdog_trips{0};  ///< counts since the start
  std::atomic<std::int64_t> started_ns{0}, ended_ns{0};  ///< times of start and end, of now_ns(); 0: not yet
  std::atomic<bool> released_fifo{false};                ///< the fixed priority was released because the ticks took too long
};

/// Statistics of a servo. Plain data.
struct ServoStats {
  double rate_hz = 0;                        ///< requested ticks per second
  bool paced = true;                         ///< woken at deadlines
  double seconds = 0;                        ///< time since the start, until the end if it has ended
  std::uint64_t ticks = 0;                   ///< number of ticks
  std::uint64_t missed_deadlines = 0;        ///< deadlines without a tick (deadline_clock.h)
  std::uint64_t late_ticks = 0;              ///< ticks more than two periods after the tick before
  std::uint64_t lost_ticks = 0;              ///< ticks in which the device was not ready
  std::uint64_t watchdog_trips = 0;          ///< number of stalls in which the device was stopped
  RealtimeReport realtime;                   ///< real-time properties that were granted
  HistogramSummary period, compute, device;  ///< summaries of the three histograms
};

/// Returns the statistics as JSON:
/// {"device", "rate_hz", "seconds", "ticks", "missed_deadlines", "late_ticks", "lost_ticks", "watchdog_trips",
///  "realtime": {"fifo", "locked", "cpu" (null: not bound), "notes"},
///  "period_us", "compute_us", "device_us": {"p50", "p99", "p999", "max", "count", "bins": [[from, count], ...]},
///  "state_hash"}
CATENA_EXPORT std::string servo_json(const ServoStats& report, const std::string& device_name, std::uint64_t state_hash);
/// Returns the statistics as a few lines of text for the user.
CATENA_EXPORT std::string servo_summary(const ServoStats& report, const std::string& device_name);

}  // namespace catena::haptics
