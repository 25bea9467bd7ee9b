/// Private to this room: what the exact and the batched tracer share.
#pragma once
#include <string>

#include "engine/flow/curve.h"
#include "engine/flow/runge_kutta.h"

namespace catena::flow {

/// One direction of a line.
struct Branch {
  std::vector<Knot> knots;  ///< the seed first; s and t signed by the direction of the march
  LineEnd end;
};

/// The end of a line where the medium gives no rate any more.
inline LineEnd line_end(Stop stop, Reason outside) {
  if (stop == Stop::outside) return {End::boundary, outside};
  if (stop == Stop::incoherent) return {End::incoherent, Reason::incoherent};
  return {End::critical, Reason::zero};
}

/// The direction at a seed, or the sentence that says why no line starts there.
Result<Vec3> seed_tangent(const Flow& flow, const Vec3& seed);
/// Length and knots of a trace as they are meant: 10 L where the length is not given.
TraceOptions filled_options(const Flow& flow, TraceOptions options);

/// One direction with the exact marcher, from a place on a line (or beside the domain's face by rounding).
Branch march_from(const Flow& flow, const Vec3& place, double sign, const TraceOptions& options);

/// Both directions, sewn at the seed.
Result<CurvePtr> sewn(const Flow& flow, const Vec3& seed, const Branch& forward, const Branch& backward);

}  // namespace catena::flow
