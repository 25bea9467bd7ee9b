/// What a servo tells of itself: counts, histograms, what the machine permitted. Readable while it runs, JSON at the end.
#pragma once
#include <cstdint>
#include <string>

#include "haptics/servo/histogram.h"
#include "haptics/servo/realtime.h"

namespace catena::haptics {

/// Written by the haptic thread (trips: by the watchdog), read by anybody: relaxed, lock-free.
struct ServoCounters {
  Histogram period;   ///< from begin to begin of two ticks
  Histogram compute;  ///< the tick alone
  Histogram device;   ///< reading and writing the device
  std::atomic<std::uint64_t> ticks{0}, missed_deadlines{0}, late_ticks{0}, lost_ticks{0}, watchdog_trips{0};
  std::atomic<std::int64_t> started_ns{0}, ended_ns{0};  ///< 0: not yet
  std::atomic<bool> left_fifo{false};                    ///< gave its fixed priority back
};

struct ServoReport {
  double rate_hz = 0;
  bool paced = true;
  double seconds = 0;
  std::uint64_t ticks = 0;
  std::uint64_t missed_deadlines = 0;  ///< deadlines that got no tick (pace.h)
  std::uint64_t late_ticks = 0;        ///< more than two periods after the tick before
  std::uint64_t lost_ticks = 0;        ///< the device was not ready
  std::uint64_t watchdog_trips = 0;
  RealtimeReport realtime;
  HistogramFigures period, compute, device;
};

/// {"device", "rate_hz", "seconds", "ticks", "missed_deadlines", "late_ticks", "lost_ticks", "watchdog_trips",
///  "realtime": {"fifo", "locked", "cpu" (null: not bound), "notes"},
///  "period_us", "compute_us", "device_us": {"p50", "p99", "p999", "max", "count", "bins": [[from, count], ...]},
///  "state_hash"}
std::string servo_json(const ServoReport& report, const std::string& device_name, std::uint64_t state_hash);
/// The same in a few lines for a person.
std::string servo_summary(const ServoReport& report, const std::string& device_name);

}  // namespace catena::haptics
