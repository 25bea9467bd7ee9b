/// How long something took, counted in buckets of equal ratio: fixed size, no allocation, readable while it is being filled.
///   below 128 ns: one bucket a nanosecond;  above: 128 buckets an octave, each 1/128 of its start wide, up to 2^40 ns
/// A quantile is the middle of its bucket: at most 1/256 (0.4 %) off. The maximum is exact.
/// One writer (the haptic thread), any number of readers; all relaxed atomics, nobody waits.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "haptics/servo/realtime.h"

namespace catena::haptics {

/// What is told of a histogram, microseconds. The q-quantile as in engine/base/numbers.h.
struct HistogramSummary {
  std::uint64_t count = 0;                                 ///< how many were counted
  double p50_us = 0, p99_us = 0, p999_us = 0, max_us = 0;  ///< quantiles and the greatest
  /// For a drawing: 8 an octave, those that are not empty, each from here to the next place of the scale.
  struct Bin {
    double from_us;       ///< where the bin begins, microseconds
    std::uint64_t count;  ///< how many lie in it
  };
  std::vector<Bin> bins = {};  ///< rising
};

/// The buckets.
class Histogram {
 public:
  void add(std::int64_t ns) noexcept;  ///< writer's thread; a negative time counts as 0
  HistogramSummary summarize() const;  ///< any thread but the writer's

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

/// What a servo tells of itself: counts, histograms, what the machine permitted. Readable while it runs, JSON at the end.

/// ImageWriteResult by the haptic thread (trips: by the watchdog), read by anybody: relaxed, lock-free.
struct ServoCounters {
  Histogram period;   ///< from begin to begin of two ticks
  Histogram compute;  ///< the tick alone
  Histogram device;   ///< reading and writing the device
  std::atomic<std::uint64_t> ticks{0}, missed_deadlines{0}, late_ticks{0}, lost_ticks{0}, watchdog_trips{0};  ///< counts since the start
  std::atomic<std::int64_t> started_ns{0}, ended_ns{0};                                                       ///< 0: not yet
  std::atomic<bool> released_fifo{false};  ///< gave its fixed priority back
};

/// What a servo tells. Plain data.
struct ServoStats {
  double rate_hz = 0;                        ///< ticks a second that were asked for
  bool paced = true;                         ///< woken at deadlines
  double seconds = 0;                        ///< since it started
  std::uint64_t ticks = 0;                   ///< that ran
  std::uint64_t missed_deadlines = 0;        ///< deadlines that got no tick (pace.h)
  std::uint64_t late_ticks = 0;              ///< more than two periods after the tick before
  std::uint64_t lost_ticks = 0;              ///< the device was not ready
  std::uint64_t watchdog_trips = 0;          ///< how often the watchdog stopped the device
  RealtimeReport realtime;                   ///< what the machine permitted
  HistogramSummary period, compute, device;  ///< figures of the three histograms
};

/// {"device", "rate_hz", "seconds", "ticks", "missed_deadlines", "max_late_ticks", "lost_ticks", "watchdog_trips",
///  "realtime": {"fifo", "locked", "cpu" (null: not bound), "notes"},
///  "period_us", "compute_us", "device_us": {"p50", "p99", "p999", "max", "count", "bins": [[from, count], ...]},
///  "state_hash"}
std::string servo_json(const ServoStats& report, const std::string& device_name, std::uint64_t state_hash);
/// The same in a few lines for a person.
std::string servo_summary(const ServoStats& report, const std::string& device_name);

}  // namespace catena::haptics
