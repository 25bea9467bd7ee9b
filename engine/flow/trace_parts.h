/// Private to this room: what the exact and the batched tracer share.
#pragma once
#include <string>

#include "engine/flow/curve.h"
#include "engine/flow/runge_kutta.h"

namespace catena::flow {

/// One direction of a line.
struct Branch {
  std::vector<Knot> knots;  ///< the seed first; s and t signed by the direction of the march
  End end = End::length;
};

/// The direction at a seed, or the sentence that says why no line starts there.
Result<Vec3> seed_tangent(const Flow& flow, const Vec3& seed);
/// Length and knots of a trace as they are meant: 10 L where the length is not given.
TraceOptions filled_options(const Flow& flow, TraceOptions options);

/// One direction with the exact marcher, from a place on a line (or beside the domain's face by rounding).
Branch march_from(const Flow& flow, const Vec3& place, double sign, const TraceOptions& options);

/// Both directions, sewn at the seed.
Result<CurvePtr> sewn(const Flow& flow, const Vec3& seed, const Branch& forward, const Branch& backward);

}  // namespace catena::flow
