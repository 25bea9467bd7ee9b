// SPDX-License-Identifier: MIT
/// Traces many streamlines at once, for images and tables of whole seed sets. The selected line of a link, and the tubes that show it, come
/// from trace() (curve.h); batch lines have a coarser, documented tolerance and are an order of magnitude cheaper.
///   grids: RK4 with an error estimate (batch_rk4_step.h), eight lines per core, on all cores. Knots are the steps; the arc length
///          follows from Simpson's rule on the cubic of each step. Where a line leaves the domain or the valid cells, or its speed
///          approaches zero, steps are halved down to 1e-4 voxels and the exact tracer (trace_internal.h) continues: line ends have
///          the same meaning BOUNDARY, CRITICAL, LENGTH, LAP. A lap closes within 0.01 voxel, or 10 tolerances, of the seed.
///   formulas, line fields (v ~ -v), cubic grids, grids of one slice: trace() itself at this tolerance, seeds distributed over all cores
/// Results do not depend on the number of threads, on the other seeds of the batch, or on AVX2. Off the haptic thread.
#pragma once
#include <span>

#include "engine/base/export.h"
#include "engine/geometry/flow/curve.h"

namespace catena::flow {

/// Accuracy and length limits of a batch.
struct BatchOptions {
  double length = 0;        ///< Maximum arc length in each direction, world units; 0: 10 L.
  double tolerance = 1e-7;  ///< Limit on the estimated error of one step, times L; at most a hundredth of the step.
  /// Maximum step size, voxels (formulas: world units); 0: half a voxel, because the error estimate misses the kinks at cell faces;
  /// where trace() does the work, its own default.
  double max_step = 0;
  std::size_t max_knots = 2000000;  ///< Maximum number of knots of a line, both directions together.
};

class VelocityBricks;

/// Caches what it has read of the grid between calls. trace() is safe from any thread.
class CATENA_EXPORT BatchTracer {
 public:
  /// The field of `flow` must outlive this object.
  BatchTracer(const Flow& flow, const BatchOptions& options = {});
  ~BatchTracer();
  /// Traces a line from each seed. Returns one result per seed, in their order; errors are those of trace().
  std::vector<Result<CurvePtr>> trace(std::span<const Vec3> seeds) const;

 private:
  Flow flow_;
  BatchOptions options_;
  std::unique_ptr<VelocityBricks> bricks_;  ///< Null: trace() is used for each seed.
};

/// Calls trace() for every seed, over all cores; the curves are bitwise equal to those of trace().
CATENA_EXPORT std::vector<Result<CurvePtr>> trace_all(const Flow& flow, std::span<const Vec3> seeds, const TraceOptions& options = {});

}  // namespace catena::flow
