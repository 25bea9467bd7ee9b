/// Pacing says which picture a window shows next: one that comes in time while something moves, better ones while nothing does. It is pure
/// logic, without window and clock.
///   moves:  the best setting whose expected time fits the budget (time=MS: MS, else kBudgetMs); where even the cheapest takes
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

#include "engine/app/render/options.h"
#include "haptics/servo/report.h"
#include "render/quality/refinement.h"

namespace catena::app {

inline constexpr double kBudgetMs = 50;

/// What the scene asks of the rays.
struct SceneKind {
  bool rays = true;  ///< something is drawn by rays: settings matter
  bool fast = true;  ///< Renderer::draws_fast
  bool shaded = false;
  bool operator==(const SceneKind&) const = default;
};

struct NextPicture {
  render::RenderSettings settings;
  std::uint32_t scale = 1;  ///< every so many pixels, each way
};

class Pacing {
 public:
  explicit Pacing(const Quality& quality);
  /// The picture after a change.
  NextPicture moving(const SceneKind& kind);
  /// The picture after the last, with nothing changed; nothing: it was the last.
  std::optional<NextPicture> still(const SceneKind& kind);
  /// The picture after nothing but opaque things has moved: as good as the last one, what has not changed of it is kept.
  NextPicture kept();
  /// Whether still() may come between pictures that are kept: exact rays only where the hand's picture does not stand for long.
  bool may_improve() const;
  /// Not where the last one that was kept came far too late, because much had moved; until something rests.
  bool may_keep() const { return !kept_late_; }
  /// The picture that still() would end with.
  NextPicture best(const SceneKind& kind);
  /// The last one.
  const NextPicture& again() const { return current_; }
  bool finished() const { return finished_; }

  /// What the picture asked for last took; asked for by again(), it says nothing new.
  void drawn(double ms);
  /// error=E: wants_estimate() after still(); the estimate ends the refinement if it is small enough. 1/255.
  bool wants_estimate() const {
    return quality_.goal && quality_.goal->kind == render::QualityGoal::Kind::error && kind_.rays && !by_moving_ && !rmse_;
  }
  void estimated(double rmse);
  /// With any other goal: the picture at rest is the last one, and its error is not known yet.
  bool may_estimate() const { return finished_ && kind_.rays && !by_moving_ && !rmse_; }
  const Quality& quality() const { return quality_; }
  std::optional<double> rmse() const { return rmse_; }  ///< of the picture that is shown, where it was estimated
  double budget_ms() const { return budget_ms_; }       ///< of a picture while something moves

  /// "fast, step 4, every 4th pixel, 32 ms"
  std::string words() const;

 private:
  void follow(const SceneKind& kind);
  NextPicture ask(const render::RefinementStep& step, std::uint32_t scale);

  Quality quality_;
  double budget_ms_;
  SceneKind kind_;
  render::Refinement refinement_;
  NextPicture current_;
  bool asked_ = false;      ///< the refinement waits for a time
  bool by_moving_ = false;  ///< current_ is from moving()
  bool finished_ = false;
  bool is_kept_ = false;  ///< the last picture is from kept()
  bool kept_late_ = false;
  double shown_ms_ = 0;
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

/// PulseClock moves the scene's phase as time goes by: pulses run along streamlines while somebody looks. Pure logic: the time is told.
class PulseClock {
 public:
  static constexpr double kTurnsPerS = 0.5;
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
    const double next = phase + kTurnsPerS * s;
    return next - std::floor(next);
  }

 private:
  std::optional<std::int64_t> last_ns_;  ///< of the last step; none: it stands
};

}  // namespace catena::app
