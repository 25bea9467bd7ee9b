/// Where nearly all of many points lie, however far a few have gone astray. Along each axis the 5 and the 95 percentile are taken, of a
/// sample; a point belongs to the core unless it lies beyond them by more than twice the widest of these three ranges. Evenly or normally
/// spread points have no strays, nor have fewer than 20. Deterministic; any thread.
#pragma once
#include <glm/vec3.hpp>
#include <span>

#include "engine/base/bounds.h"

namespace catena::curves {

/// What compute_robust_bounds() finds.
struct RobustBounds {
  Bounds box;                ///< of the points that are no strays; empty: there are no points
  std::size_t outliers = 0;  ///< how many are
};
/// The box of all points but strays.
RobustBounds compute_robust_bounds(std::span<const glm::vec3> points);

}  // namespace catena::curves
