/// Many streamlines at once: for pictures and tables of whole sets of seeds. The selected line of a link and the tubes that show
/// it stay trace()'s one curve (curve.h); these are lines of a stated, coarser tolerance, and an order of magnitude cheaper.
///   grids: RK4 with an error estimate (batch_step.h), eight lines a core in turn, all cores; knots are the steps, with the arc
///          length by Simpson's rule on each step's cubic. Where a line leaves the domain or its valid cells, or slows down to
///          nothing, steps are halved to 1e-4 voxels and the exact marcher (march.h) takes over for a while: ends mean the same
///          BOUNDARY, CRITICAL, LENGTH, LAP. A lap closes within 0.01 voxel, or 10 tolerances, of the seed.
///   formulas, line fields (v ~ -v), cubic grids, grids of one layer: trace() itself at this tolerance, seeds over all cores
/// Results do not depend on the number of threads, nor on which other seeds are in the batch, nor on AVX2. Off the tick.
#pragma once
#include <span>

#include "engine/geometry/flow/curve.h"

namespace catena::flow {

/// How finely and how far.
struct BatchOptions {
  double length = 0;                ///< longest arc length in each direction, world units; 0: 10 L
  double tolerance = 1e-7;          ///< of the estimated error of one step, times L; never above a hundredth of the step
  double max_step = 0;              ///< voxels, of a formula world units; 0: half a voxel, which bounds what the estimate cannot see,
                                    ///< the kinks at the faces of cells
  std::size_t max_knots = 2000000;  ///< of one line, both directions together
};

class VelocityBricks;

/// Keeps what it has read of the grid between calls: the flow's field must outlive it.
class BatchTracer {
 public:
  /// Of a flow, whose field outlives this.
  BatchTracer(const Flow& flow, const BatchOptions& options = {});
  ~BatchTracer();
  /// One result a seed, in their order; errors are trace()'s.
  std::vector<Result<CurvePtr>> trace(std::span<const Vec3> seeds) const;

 private:
  Flow flow_;
  BatchOptions options_;
  std::unique_ptr<VelocityBricks> bricks_;  ///< null: trace() serves
};

/// trace() for every seed, over all cores: the same curves, bit for bit.
std::vector<Result<CurvePtr>> trace_all(const Flow& flow, std::span<const Vec3> seeds, const TraceOptions& options = {});

}  // namespace catena::flow
