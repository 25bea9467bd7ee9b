// SPDX-License-Identifier: MIT
/// Integration settings of a streamline link and their measured curve, shared by `tradeoff` and the tick tuning. Not for the haptic thread.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/app/tuning/measure/workload.h"
#include "engine/geometry/flow/curve.h"

namespace catena::app::tuning {

/// One way to follow a streamline: the line traced in advance, or an integration method.
struct StreamlineSetting {
  std::string label, series;                              ///< Label and series of its point (Point::setting, Point::series).
  std::vector<std::pair<std::string, std::string>> keys;  ///< Keys of the link and their values as JSON text.
  bool is_selected = false;                               ///< The line is traced once, before the first tick.
  std::optional<flow::Method> method{};                   ///< Integration method of online following; none if is_selected.
  std::optional<double> tolerance{};                      ///< Tolerance of an embedded method, in units of L; none for other methods.
  /// Returns the keys as written in a scene; if the link states contradicting keys, also which ones they replace (Point::config_text).
  std::string config_text(const NamedLink& link) const;
};

/// Returns all settings, the line traced in advance first; embedded methods with tolerances 1e-3 to 1e-13 and the link's own.
std::vector<StreamlineSetting> streamline_settings(const json::Node& link);

/// The streamline that a link specifies.
struct StreamlineSource {
  field::VectorFieldPtr field;
  flow::Flow flow;  ///< Flow of `field`.
  Vec3 seed{0.0};   ///< World position of the link's seed.
};
/// Returns the streamline of a link. An Error, one sentence, if it has no vector field, or no seed before contact.
Result<StreamlineSource> resolve_link_streamline(scene::Scene& scene, const NamedLink& link);

/// Returns the options for tracing the reference line of the errors, `length` each way, world units; 0: the maximum length.
flow::TraceOptions converged_trace_options(double length);

/// Measures the curve of one link. An Error if no line can be traced from its seed.
Result<Curve> measure_streamline_link(Workload& subject, const NamedLink& link);

/// Returns the id of a streamline link's curve.
inline std::string streamline_curve_id(const std::string& link) { return "hand-streamline-" + link; }

}  // namespace catena::app::tuning
