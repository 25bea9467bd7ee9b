// SPDX-License-Identifier: MIT
/// Tick tuning: the choice of the integration method of each streamline link from measured curves of error against time
/// (tradeoff/measure/haptics).
///   max_proxy_error=E  for each link the cheapest setting whose error is at most E, or at most the discretization error if that is larger
///   max_tick_us=T      the least error of the worst link for which the whole tick takes at most T microseconds
/// An error is the largest distance of a link's proxy from the converged line, world units. The time of a tick is the time without these
/// links plus what each of them adds. A link that states its method ("follow", "method", "tolerance") keeps it.
/// If the target lies below the error of linear interpolation, a sampled field that does not state its "interpolation" becomes cubic if
/// that is known to leave less than half of that error: for all links of the field, and for rendering.
/// The tuning is made before the first tick and written into the links as if the scene had stated it; the program, a recording and its
/// replay are independent of curves and clocks. Not for the haptic thread.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/app/tuning/measure/workload.h"
#include "engine/app/tuning/store/curve_cache.h"
#include "engine/scene/scene.h"

namespace catena::app::tuning {

/// Keys of a link and their values as JSON text: {"method", "\"dp54\""}.
using LinkKeys = std::vector<std::pair<std::string, std::string>>;

/// A link that leaves its setting open, with its measured curve: one entry for linear interpolation and, where the field leaves that open,
/// another for cubic.
struct LinkCurve {
  std::string link, field;
  bool is_cubic = false;
  double length = 1;           ///< Length L of the field's domain, world units; errors of the curve are in units of L.
  double ticks_per_ms = 1;     ///< Servo ticks per millisecond: the curve's times are per millisecond of simulated time.
  Curve curve;                 ///< Only the points compatible with what the link states.
  std::vector<LinkKeys> keys;  ///< One per point.
};

/// The curves of all links that leave their setting open.
struct TickCurves {
  std::vector<LinkCurve> links;
  double base_tick_ns = 0;   ///< Time of a tick without those links.
  double empty_tick_ns = 0;  ///< Time of a tick without any link; included in the time of each link's curve.
};

/// The setting chosen for one link.
struct TunedLink {
  std::string link, setting;
  LinkKeys keys;
  double error = 0;  ///< Expected, world units.
  /// Error anywhere along the line that is traced in advance, world units; 0: not traced in advance, unknown, or not much larger than
  /// `error`.
  double error_anywhere = 0;
  double discretization_error = 0;  ///< Resolvable error: discretization error or error of the reference, whichever is larger; world units.
  bool at_floor = false, meets_target = true;
};

/// The settings chosen for the targets, with expected error and time. An empty tuning has no links.
class TickTuning {
 public:
  TickTuning() = default;
  TickTuning(TickCurves curves, const scene::TuningTargets& targets);

  bool is_empty() const { return links_.empty(); }
  const std::vector<TunedLink>& links() const { return links_; }
  /// Fields that are switched to cubic interpolation.
  const std::vector<std::string>& cubic_fields() const { return cubic_fields_; }
  double expected_error() const;  ///< Error of the worst link, world units, on paths like the measured one.
  /// Error of the worst link wherever the probe goes, world units; larger than expected_error() only where it is much larger. Small errors
  /// grow along a line, in a chaotic flow up to the size of the flow, so that distant parts of a line traced in advance may lie anywhere.
  double error_anywhere() const;
  /// Expected time per tick, microseconds.
  double expected_us() const { return 1e-3 * tick_ns_; }
  bool meets_target() const { return meets_target_; }
  const scene::TuningTargets& targets() const { return targets_; }
  /// Replaces the targets and chooses again.
  void set_targets(const scene::TuningTargets& targets);

  /// Errors at which the choice changes, in descending order: from the fastest setting to the most exact one.
  std::vector<double> error_breakpoints() const;

  /// Writes the settings into the links and fields of a scene that was just loaded. Links and fields that state a setting keep it.
  void apply(scene::Scene& scene) const;
  /// Returns the text of a scene with these settings written into it; `file` names the text in messages. Error: the text cannot be parsed.
  Result<std::string> apply(const std::string& text, const std::string& file) const;

  /// Returns "max_proxy_error 1e-06: curve rkf34, tolerance 1e-07; expected: error 3.1e-07 in 1.9 us per tick", with a remark if the target
  /// cannot be met.
  std::string summary() const;

 private:
  struct Choice {
    std::vector<TunedLink> links;
    std::vector<std::string> cubic_fields;  ///< Fields switched to cubic interpolation.
    double ns = 0;                          ///< Expected time of the tick, nanoseconds.
  };
  /// Returns the cheapest choice whose error does not exceed `error`, world units.
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

/// Applies the integration settings and interpolations stated in a recording's scene text to a scene given separately that leaves them
/// open. An Error if the text cannot be parsed.
Outcome apply_recorded_settings(const std::string& recorded_text, scene::Scene& scene);

/// Measures the links that leave their setting open. Workload::skipped receives a sentence for each link that cannot be measured.
Result<std::vector<Curve>> measure_tick_curves(tuning::Workload& subject);
/// Matches measured or cached curves with the links of the scene; nothing if they do not fit it. `rate_hz`: rate of the servo.
std::optional<TickCurves> to_tick_curves(scene::Scene& scene, const std::vector<Curve>& curves, double rate_hz);

}  // namespace catena::app::tuning
