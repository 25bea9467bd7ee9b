/// What a streamline link can be asked for, and the curve of it. One place for `tradeoff` and for plans. Off the haptic thread.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/app/tuning/tradeoff/measure/workload.h"
#include "engine/geometry/flow/curve.h"

namespace catena::app::tradeoff {

struct StreamlineSetting {
  std::string label, series;                              ///< of its point
  std::vector<std::pair<std::string, std::string>> keys;  ///< of the link, as JSON text
  bool is_selected = false;                               ///< traced once
  std::optional<flow::Method> method{};                   ///< of online following
  std::optional<double> tolerance{};                      ///< of an embedded one, L
  /// The keys as a scene has them; where the link states keys that contradict them, also what they replace (Point::write).
  std::string config_text(const NamedLink& link) const;
};

/// All of them, the traced line first; embedded methods with tolerances 1e-3 .. 1e-13 and the link's own.
std::vector<StreamlineSetting> streamline_settings(const json::Node& link);

/// What a link says of its line.
struct StreamlineSource {
  field::VectorFieldPtr field;
  flow::Flow flow;  ///< of that field
  Vec3 seed{0.0};
};
/// An error, one sentence, where it has no vector field, or no seed before it is felt.
Result<StreamlineSource> resolve_link_streamline(scene::Scene& scene, const NamedLink& link);

/// How a line is traced that errors are measured from: so far each way, world units; 0: as far as any is.
flow::TraceOptions converged_trace_options(double length);

/// The curve of one link.
Result<Curve> measure_streamline_link(Workload& subject, const NamedLink& link);

inline std::string streamline_curve_id(const std::string& link) { return "hand-streamline-" + link; }

}  // namespace catena::app::tradeoff
