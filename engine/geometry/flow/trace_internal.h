/// Private to this room: what the exact and the batched tracer share.
#pragma once
#include <string>

#include "engine/geometry/flow/curve.h"
#include "engine/geometry/flow/runge_kutta.h"

namespace catena::flow {

/// One direction of a line.
struct Branch {
  std::vector<Knot> knots;  ///< the seed first; s and t signed by the direction of the march
  LineEnd end;
};

/// The end of a line where the medium gives no rate any more.
inline LineEnd make_line_end(StopReason stop, SampleStatus outside) {
  if (stop == StopReason::outside) return {Termination::boundary, outside};
  if (stop == StopReason::incoherent) return {Termination::incoherent, SampleStatus::incoherent};
  return {Termination::critical, SampleStatus::zero};
}

/// The direction at a seed, or the sentence that says why no line starts there.
Result<Vec3> seed_tangent(const Flow& flow, const Vec3& seed);
/// Length and knots of a trace as they are meant: 10 L where the length is not given.
TraceOptions resolve_options(const Flow& flow, TraceOptions options);

/// One direction with the exact marcher, from a place on a line (or beside the domain's face by rounding).
Branch trace_branch(const Flow& flow, const Vec3& place, double sign, const TraceOptions& options);

/// Both directions, sewn at the seed.
Result<CurvePtr> join_branches(const Flow& flow, const Vec3& seed, const Branch& forward, const Branch& backward);

}  // namespace catena::flow
