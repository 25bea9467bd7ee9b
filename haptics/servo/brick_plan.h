// SPDX-License-Identifier: MIT
/// Plan of the bricks around moving positions, the most urgent first (brick_pager.h). Any thread.
#pragma once
#include <span>
#include <vector>

#include "engine/field/bricks/paged_grid.h"

namespace catena::haptics {

/// Position that ticks sample, with its velocity; world units, per second.
struct WatchedPosition {
  Vec3 position{0.0}, velocity{0.0};
};

/// Distances of a plan.
struct PlanLimits {
  double near_voxels = 0;      ///< margin of bricks that the next ticks may sample
  double look_ahead_s = 0;     ///< time for which positions are extrapolated
  std::size_t max_bricks = 0;  ///< length of the plan
};

/// Returns the bricks of a grid, each once: those near the positions, near their extrapolations by time, then those around by distance.
std::vector<field::BrickId> plan_bricks(const field::PagedGrid& grid, std::span<const WatchedPosition> positions, const PlanLimits& limits);

}  // namespace catena::haptics
