// SPDX-License-Identifier: MIT
/// Bounding box of a point set without its outliers. The 5th and 95th percentiles along each axis are estimated from a sample; a point is
/// an outlier when it lies outside of them by more than twice the widest of the three ranges. Uniformly or normally distributed points have
/// no outliers, nor have sets of fewer than 20 points. Deterministic; any thread.
#pragma once
#include <glm/vec3.hpp>
#include <span>

#include "engine/base/bounds.h"
#include "engine/base/export.h"

namespace catena::curves {

/// Result of compute_robust_bounds().
struct RobustBounds {
  Bounds box;                ///< Bounding box of the points that are not outliers; empty: there are no points.
  std::size_t outliers = 0;  ///< Number of outliers.
};
/// Computes the bounding box without outliers; see the top of this file.
CATENA_EXPORT RobustBounds compute_robust_bounds(std::span<const glm::vec3> points);

}  // namespace catena::curves
