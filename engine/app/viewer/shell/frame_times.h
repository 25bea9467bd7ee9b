/// FrameTimes records how long pictures took, for the panel and for --frame-stats; its size is fixed however long the session is.
#pragma once
#include <array>
#include <cstddef>
#include <string>

#include "haptics/servo/histogram.h"

namespace catena::app {

class FrameTimes {
 public:
  static constexpr std::size_t kRecent = 240;

  /// A picture was drawn in `ms` and stood in the window at `now_ns`.
  void add(double ms, std::int64_t now_ns);
  /// One more user interface was laid over a picture, in `ms`.
  void add_interface(double ms) { interface_.add(static_cast<std::int64_t>(1e6 * ms)); }

  int count() const { return count_; }
  haptics::HistogramFigures draw() const { return draw_.figures(); }
  haptics::HistogramFigures period() const { return period_.figures(); }  ///< from picture to picture, pauses of a second left out
  haptics::HistogramFigures interface() const { return interface_.figures(); }
  /// The newest kRecent pictures, milliseconds, as a ring that begins at `recent_first()`.
  const std::array<float, kRecent>& recent() const { return recent_; }
  std::size_t recent_first() const { return static_cast<std::size_t>(count_) % kRecent; }

  /// {"frames", "draw_us", "period_us", "interface_us": {"p50", "p99", "p999", "max", "count", "bins"}}
  std::string json() const;

 private:
  haptics::Histogram draw_, period_, interface_;
  std::array<float, kRecent> recent_{};
  int count_ = 0;
  std::int64_t last_ns_ = 0;
};

}  // namespace catena::app
