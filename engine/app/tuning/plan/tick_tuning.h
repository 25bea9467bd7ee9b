/// The hand's plan: how each streamline link is followed, from measured curves of error against time (tradeoff/measure/hand).
///   hand_error=E  for each link the cheapest setting whose error is at most E, or the data's own if that is greater
///   max_tick_us=T   the least error of the worst link for which the whole tick takes T microseconds at most
/// Errors are the greatest distance of a link's proxy from the converged line, world units; the time of a tick is that of the tick without
/// these links, and what each of them adds. A link that says how it is followed ("follow", "method", "tolerance") keeps what it says.
/// Below the error that linear cells leave in the data, a sampled field that does not state its "interpolation" becomes cubic where that
/// is known to leave less than half of it: for all links of the field, and for the eye.
/// The plan is made before the first tick and written into the links as if the scene had said it: the program, a recording and its replay
/// know nothing of curves and clocks. Off the tick.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/app/tuning/plan/curve_cache.h"
#include "engine/app/tuning/tradeoff/measure/workload.h"
#include "engine/scene/scene.h"

namespace catena::app::plan {

/// Keys of a link as JSON text: {"method", "\"dp54\""}.
using LinkKeys = std::vector<std::pair<std::string, std::string>>;

/// A link that leaves its setting open, and what is known of each; once with linear cells and, where the field leaves that open, once more
/// with cubic ones.
struct LinkCurve {
  std::string link, field;
  bool is_cubic = false;
  double length = 1;           ///< L of its field, world units: the curve's errors are shares of it
  double ticks_per_ms = 1;     ///< the curve's times are of a millisecond
  Curve curve;                 ///< only what agrees with what the link says
  std::vector<LinkKeys> keys;  ///< one a point
};

struct TickCurves {
  std::vector<LinkCurve> links;
  double base_tick_ns = 0;   ///< a tick without those links
  double empty_tick_ns = 0;  ///< a tick without any: it is in each link's time
};

/// What one link gets.
struct TunedLink {
  std::string link, setting;
  LinkKeys keys;
  double error = 0;           ///< expected, world units
  double error_anywhere = 0;  ///< of the line that is traced once, anywhere along it; world units; 0: of what is not traced, or not known
  double discretization_error = 0;  ///< the data's own, or what the reference can tell; world units
  bool at_floor = false, meets_target = true;
};

class TickTuning {
 public:
  TickTuning() = default;
  TickTuning(TickCurves curves, const scene::TuningTargets& wanted);

  bool is_empty() const { return links_.empty(); }
  const std::vector<TunedLink>& links() const { return links_; }
  /// The fields that become cubic.
  const std::vector<std::string>& cubic_fields() const { return cubic_fields_; }
  double expected_error() const;  ///< of the worst link, world units, on ways like the measured one
  /// The same wherever the hand goes, where that is much more: small errors grow along a line, and in a chaotic flow to the size of the
  /// flow, so that a far pass of a line that was traced once may be anywhere.
  double error_anywhere() const;
  double expected_us() const { return 1e-3 * tick_ns_; }
  bool meets_target() const { return meets_target_; }
  const scene::TuningTargets& targets() const { return targets_; }
  void set_targets(const scene::TuningTargets& wanted);

  /// From the fastest to the most exact: the errors at which what is chosen changes, falling.
  std::vector<double> error_breakpoints() const;

  /// Into the links and fields of a scene that was just read; into its text. What has come to say it itself keeps what it says.
  void apply(scene::Scene& scene) const;
  Result<std::string> apply(const std::string& text, const std::string& file) const;

  /// "plan hand_error=1e-06: curve rkf34, tolerance 1e-07; expected: error 3.1e-07 in 1.9 us", and what could not be had.
  std::string summary() const;

 private:
  struct Choice {
    std::vector<TunedLink> links;
    std::vector<std::string> cubic_fields;  ///< fields
    double ns = 0;                          ///< of the tick
  };
  /// For the error.
  Choice pick(double error) const;
  std::vector<std::string> choose_cubic_fields(double error) const;
  void adopt(Choice choice);

  TickCurves curves_;
  scene::TuningTargets targets_;
  std::vector<TunedLink> links_;
  std::vector<std::string> cubic_fields_;
  double tick_ns_ = 0;
  bool meets_target_ = true;
};

/// What the recording's text says of how links are followed and fields are read, for a scene from outside whose plan leaves it open.
Outcome apply_recorded_settings(const std::string& recorded_text, scene::Scene& scene);

/// Measures the links that leave their setting open. `left_out` gets a sentence for each that cannot be measured.
Result<std::vector<Curve>> measure_tick_curves(tradeoff::Workload& subject);
/// What those curves, or kept ones, are of this scene; nothing where they do not fit it.
std::optional<TickCurves> to_tick_curves(scene::Scene& scene, const std::vector<Curve>& curves, double rate_hz);

}  // namespace catena::app::plan
