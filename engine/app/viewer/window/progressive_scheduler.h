// SPDX-License-Identifier: MIT
/// Progressive rendering: selects the settings of the next frame, fast ones while something moves, better ones when idle. Pure logic,
/// independent of window and clock.
///   interactive: the best setting whose expected time fits the frame budget (time=MS: MS, else kFrameBudgetMs); if even the cheapest
///                takes longer, fewer pixels
///   reused:      the probe moves and nothing that rays meet has changed: as good as the last frame (RenderSettings::reuse_rays)
///   refined:     time=MS: quarter -> half -> every pixel; error=E: the same until the estimated error of a frame is at most E;
///                draft, balanced, reference, step=VOXELS: that setting immediately
/// Contours of opaque items are antialiased in refined frames, and in motion where there is ample time.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "engine/app/render/render_options.h"
#include "haptics/servo/servo_stats.h"
#include "render/quality/refinement.h"

namespace catena::app {

/// Default time for an interactive frame, milliseconds; time from frame to frame that is aimed at with the interface drawn over the image
/// (15 frames per second); minimum time for the image where the interface takes most of it.
inline constexpr double kFrameBudgetMs = 50, kFramePeriodMs = 1000.0 / 15, kMinFrameBudgetMs = 20;

/// Requirements of the scene on ray casting.
struct RayWorkload {
  bool uses_rays = true;      ///< Something is rendered by rays, so that the settings matter.
  bool supports_fast = true;  ///< Value of Renderer::can_draw_fast.
  bool is_shaded = false;
  bool operator==(const RayWorkload&) const = default;
};

/// Settings of the frame to render next.
struct FrameRequest {
  render::RenderSettings settings;
  std::uint32_t pixel_stride = 1;  ///< Every n-th pixel is rendered in each direction.
};

/// State of the refinement.
class ProgressiveScheduler {
 public:
  explicit ProgressiveScheduler(const Quality& quality);
  /// Returns the frame after a change.
  FrameRequest interactive_frame(const RayWorkload& kind);
  /// Returns the frame after the last one, with nothing changed; nothing if the last one was final.
  std::optional<FrameRequest> refined_frame(const RayWorkload& kind);
  /// Returns the frame after a motion of opaque items only: as good as the last one, reusing the unchanged rays.
  FrameRequest reused_frame();
  /// Returns whether refined_frame() may be interleaved with reused frames: with exact rays only if that does not stop the probe's image
  /// for long.
  bool may_refine() const;
  /// Returns false after a reused frame took far too long because much had moved, until the next refined frame.
  bool may_reuse() const { return !reuse_too_slow_; }
  /// Returns the frame that refined_frame() ends with.
  FrameRequest final_frame(const RayWorkload& kind);
  /// Returns the last request.
  const FrameRequest& current() const { return current_; }
  /// Returns whether the last frame is final.
  bool is_finished() const { return is_finished_; }

  /// Reduces the default time for interactive frames to what the interface leaves of kFramePeriodMs. `ms`: time of the last interface.
  void on_interface_drawn(double ms);
  /// Records the time of the last requested frame; the time of a reused frame does not count for its setting.
  void on_rendered(double ms);
  /// Returns whether, for error=E, the error of a refined frame must be estimated; set_estimate(), in 1/255, ends the refinement if it is
  /// small enough.
  bool needs_estimate() const {
    return quality_.goal && quality_.goal->kind == render::QualityGoal::Kind::error && workload_.uses_rays && !is_interactive_ && !rmse_;
  }
  void set_estimate(double rmse);
  /// Returns whether the error of the final frame can be estimated and is not known yet, for any goal.
  bool may_estimate() const { return is_finished_ && workload_.uses_rays && !is_interactive_ && !rmse_; }
  const Quality& quality() const { return quality_; }
  std::optional<double> rmse() const { return rmse_; }  ///< Error of the shown frame, if estimated.
  double budget_ms() const { return budget_ms_; }       ///< Time for an interactive frame.

  /// Returns "fast, step 4, every 4th pixel, 32 ms".
  std::string status_text() const;

 private:
  void set_workload(const RayWorkload& kind);
  FrameRequest request(const render::RefinementStep& step, std::uint32_t scale);

  Quality quality_;
  double budget_ms_;
  RayWorkload workload_;
  render::Refinement refinement_;
  FrameRequest current_;
  bool awaits_time_ = false;     ///< The refinement waits for the time of a frame.
  bool is_interactive_ = false;  ///< The last request is from interactive_frame().
  bool is_finished_ = false;
  bool is_reused_ = false;  ///< The last request is from reused_frame().
  bool reuse_too_slow_ = false;
  bool smooths_in_motion_ = false;  ///< Frames in motion have antialiased contours.
  double last_image_ms_ = 0;
  double interface_ms_ = 0;  ///< moving average
  std::optional<double> rmse_;
};

/// Statistics of frame times, for the panel and for --frame-stats; of constant size for any length of the session.
class FrameTimes {
 public:
  /// Number of recent frames kept.
  static constexpr std::size_t kRecent = 240;

  /// Records a frame rendered in `ms` milliseconds and shown at `now_ns`.
  void add(double ms, std::int64_t now_ns);
  /// Records a GUI drawn over the image in `ms` milliseconds.
  void add_interface(double ms) { interface_.add(static_cast<std::int64_t>(1e6 * ms)); }

  int count() const { return count_; }
  haptics::HistogramSummary draw_times() const { return draw_.summarize(); }
  haptics::HistogramSummary periods() const { return period_.summarize(); }  ///< Frame to frame, without pauses of 1 s or more.
  haptics::HistogramSummary interface_times() const { return interface_.summarize(); }
  /// Returns the latest kRecent frame times in milliseconds, as a ring buffer starting at recent_begin().
  const std::array<float, kRecent>& recent() const { return recent_; }
  std::size_t recent_begin() const { return static_cast<std::size_t>(count_) % kRecent; }

  /// Returns {"frames", "draw_us", "period_us", "interface_us": {"p50", "p99", "p999", "max", "count", "bins"}}.
  std::string to_json() const;

 private:
  haptics::Histogram draw_, period_, interface_;
  std::array<float, kRecent> recent_{};
  int count_ = 0;
  std::int64_t last_ns_ = 0;
};

/// Advances the animation phase of the scene: animated bands run along streamlines while the window has focus or pointer. Pure logic: the
/// time is passed in.
class BandAnimationClock {
 public:
  static constexpr double kCyclesPerS = 0.5;
  static constexpr double kStepS = 0.04;  ///< Minimum step: at most 25 frames per second for animated bands alone.

  /// Returns the phase (0 to 1) to render at this time; nothing if it has not changed. Time does not count while not `running`.
  std::optional<double> advance(std::int64_t now_ns, bool running, double phase) {
    const std::optional<std::int64_t> before = last_ns_;
    if (!running || !before) {
      last_ns_ = running ? std::optional(now_ns) : std::nullopt;
      return std::nullopt;
    }
    const double s = 1e-9 * static_cast<double>(now_ns - *before);
    if (s < kStepS) return std::nullopt;
    last_ns_ = now_ns;
    const double next = phase + kCyclesPerS * s;
    return next - std::floor(next);
  }

 private:
  std::optional<std::int64_t> last_ns_;  ///< Time of the last step; empty: not running.
};

}  // namespace catena::app
