// SPDX-License-Identifier: MIT
/// Private to this module: shared by the exact tracer and the batch tracer.
#pragma once
#include <string>

#include "engine/geometry/flow/curve.h"
#include "engine/geometry/flow/runge_kutta.h"

namespace catena::flow {

/// A line traced in one direction from its seed.
struct Branch {
  std::vector<Knot> knots;  ///< The seed first; s and t are signed by the direction of the trace.
  LineEnd end;
};

/// End of a line where the flow source has no rate. `outside`: its status outside the domain.
inline LineEnd make_line_end(StopReason stop, SampleStatus outside) {
  if (stop == StopReason::outside) return {Termination::boundary, outside};
  if (stop == StopReason::incoherent) return {Termination::incoherent, SampleStatus::incoherent};
  return {Termination::critical, SampleStatus::zero};
}

/// Returns the direction at a seed, or an Error with the complete message why no line starts there.
Result<Vec3> seed_tangent(const Flow& flow, const Vec3& seed);
/// Replaces the default values: length 10 L, no limit on the step size; and halves max_knots, for one direction.
TraceOptions resolve_options(const Flow& flow, TraceOptions options);

/// Traces one direction with the exact tracer, from a position on a line (or, by rounding, next to the domain boundary).
Branch trace_branch(const Flow& flow, const Vec3& start, double sign, const TraceOptions& options);

/// Joins both directions at the seed. Returns an Error when the line has no length in either direction.
Result<CurvePtr> join_branches(const Flow& flow, const Vec3& seed, const Branch& forward, const Branch& backward);

}  // namespace catena::flow
