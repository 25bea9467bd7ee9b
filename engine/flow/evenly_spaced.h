/// Streamlines that keep a distance from each other, after Jobard and Lefer (1997), in space.
///   seeds   at `distance` from a line that is there, to four sides of its tangent, every `distance` along it, and kept only where
///           no line is nearer than `distance`
///   lines   grow both ways and end where they come nearer than `test * distance` to another line, or to themselves; lines
///           shorter than `distance` are dropped
/// Lines of the batch tracer (batch.h), which are the same whatever the number of threads: so is the set. Off the tick.
#pragma once
#include "engine/flow/batch.h"

namespace catena::flow {

struct EvenlySpaced {
  double distance = 0;  ///< world units, > 0
  double test = 0.5;    ///< times the distance, 0 < test <= 1
  std::vector<Vec3> start;
  std::size_t most_lines = 20000;
};

/// In order of acceptance; the first start that begins a line is the first line. Empty where none does.
std::vector<CurvePtr> evenly_spaced(const Flow& flow, const EvenlySpaced& spacing, const BatchOptions& options = {});

/// The part s0..s1 of a curve that is not closed, or of one lap of a closed one; its ends inside the curve are LENGTH.
CurvePtr part_of(const Curve& curve, double s0, double s1);

}  // namespace catena::flow
