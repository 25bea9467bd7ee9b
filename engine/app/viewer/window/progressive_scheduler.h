/// ProgressiveScheduler says which picture a window shows next: one that comes in time while something moves, better ones while nothing
/// does. It is pure logic, without window and clock.
///   moves:  the best setting whose expected time fits the budget (time=MS: MS, else kFrameBudgetMs); where even the cheapest takes
///           longer, fewer pixels
///   a hand moves, and nothing that rays meet: as good as the last picture (RenderSettings::keep)
///   still:  time=MS: quarter -> half -> every pixel; error=E: the same until a picture's estimated error is at most E;
///           draft, balanced, reference, step=VOXELS: that setting at once
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

inline constexpr double kFrameBudgetMs = 50;

/// What the scene asks of the rays.
struct RayWorkload {
  bool uses_rays = true;      ///< something is drawn by rays: settings matter
  bool supports_fast = true;  ///< Renderer::can_draw_fast
  bool is_shaded = false;
  bool operator==(const RayWorkload&) const = default;
};

struct FrameRequest {
  render::RenderSettings settings;
  std::uint32_t pixel_stride = 1;  ///< every so many pixels, each way
};

class ProgressiveScheduler {
 public:
  explicit ProgressiveScheduler(const Quality& quality);
  /// The picture after a change.
  FrameRequest interactive_frame(const RayWorkload& kind);
  /// The picture after the last, with nothing changed; nothing: it was the last.
  std::optional<FrameRequest> refined_frame(const RayWorkload& kind);
  /// The picture after nothing but opaque things has moved: as good as the last one, what has not changed of it is kept.
  FrameRequest reused_frame();
  /// Whether still() may come between pictures that are kept: exact rays only where the hand's picture does not stand for long.
  bool may_refine() const;
  /// Not where the last one that was kept came far too late, because much had moved; until something rests.
  bool may_reuse() const { return !reuse_too_slow_; }
  /// The picture that still() would end with.
  FrameRequest final_frame(const RayWorkload& kind);
  /// The last one.
  const FrameRequest& current() const { return current_; }
  bool is_finished() const { return is_finished_; }

  /// What the picture asked for last took; asked for by again(), it says nothing new.
  void on_rendered(double ms);
  /// error=E: needs_estimate() after still(); the estimate ends the refinement if it is small enough. 1/255.
  bool needs_estimate() const {
    return quality_.goal && quality_.goal->kind == render::QualityGoal::Kind::error && workload_.uses_rays && !is_interactive_ && !rmse_;
  }
  void set_estimate(double rmse);
  /// With any other goal: the picture at rest is the last one, and its error is not known yet.
  bool may_estimate() const { return is_finished_ && workload_.uses_rays && !is_interactive_ && !rmse_; }
  const Quality& quality() const { return quality_; }
  std::optional<double> rmse() const { return rmse_; }  ///< of the picture that is shown, where it was estimated
  double budget_ms() const { return budget_ms_; }       ///< of a picture while something moves

  /// "fast, step 4, every 4th pixel, 32 ms"
  std::string status_text() const;

 private:
  void set_workload(const RayWorkload& kind);
  FrameRequest request(const render::RefinementStep& step, std::uint32_t scale);

  Quality quality_;
  double budget_ms_;
  RayWorkload workload_;
  render::Refinement refinement_;
  FrameRequest current_;
  bool awaits_time_ = false;     ///< the refinement waits for a time
  bool is_interactive_ = false;  ///< current_ is from moving()
  bool is_finished_ = false;
  bool is_reused_ = false;  ///< the last picture is from kept()
  bool reuse_too_slow_ = false;
  double last_image_ms_ = 0;
  std::optional<double> rmse_;
};

/// FrameTimes records how long pictures took, for the panel and for --frame-stats; its size is fixed however long the session is.
class FrameTimes {
 public:
  static constexpr std::size_t kRecent = 240;

  /// A picture was drawn in `ms` and stood in the window at `now_ns`.
  void add(double ms, std::int64_t now_ns);
  /// One more user interface was laid over a picture, in `ms`.
  void add_interface(double ms) { interface_.add(static_cast<std::int64_t>(1e6 * ms)); }

  int count() const { return count_; }
  haptics::HistogramSummary draw_times() const { return draw_.summarize(); }
  haptics::HistogramSummary periods() const { return period_.summarize(); }  ///< from picture to picture, pauses of a second left out
  haptics::HistogramSummary interface_times() const { return interface_.summarize(); }
  /// The newest kRecent pictures, milliseconds, as a ring that begins at `recent_begin()`.
  const std::array<float, kRecent>& recent() const { return recent_; }
  std::size_t recent_begin() const { return static_cast<std::size_t>(count_) % kRecent; }

  /// {"frames", "draw_us", "period_us", "interface_us": {"p50", "p99", "p999", "max", "count", "bins"}}
  std::string to_json() const;

 private:
  haptics::Histogram draw_, period_, interface_;
  std::array<float, kRecent> recent_{};
  int count_ = 0;
  std::int64_t last_ns_ = 0;
};

/// BandAnimationClock moves the scene's phase as time goes by: pulses run along streamlines while somebody looks. Pure logic: the time is
/// told.
class BandAnimationClock {
 public:
  static constexpr double kCyclesPerS = 0.5;
  static constexpr double kStepS = 0.04;  ///< no more than 25 new pictures a second for pulses alone

  /// The phase (0 to 1) to draw now; nothing where it has not moved. While not `running` time does not count.
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
  std::optional<std::int64_t> last_ns_;  ///< of the last step; none: it stands
};

}  // namespace catena::app
