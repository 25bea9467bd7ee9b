// SPDX-License-Identifier: MIT
/// Kind of vectors in a grid, from their values: a flow, whose magnitudes are speeds, or fibers. Off the tick, any thread; deterministic.
///
/// Evaluated on at most about a quarter of a million vectors, in blocks of 8^3 spread over the box, without invalid cells and without
/// magnitudes beyond the display range (engine/field/field_display_range.h).
///   unit length  fibers: the 2 and 99 percentile of the magnitudes above 0 are within 2 % of each other
///   line field   v and -v are equivalent: neighbors along x point to opposite sides (cosine below -0.5) in over 0.1 % of the pairs if the
///                vectors have unit length, else in over 30 %. Random signs give half of the pairs, a flow next to none, vectors without
///                any order a quarter.
#pragma once
#include <vector>

#include "engine/field/grid/grid.h"

namespace catena::scene {

/// Speed, as a share of the fast speed, below which the field is stagnant; relevant where over half of the field is that slow.
inline constexpr double kStillSpeedRatio = 0.05;

/// Statistics of the vectors of a grid.
struct VectorStats {
  double slow_speed = 0, fast_speed = 0;               ///< 2 percentile of the magnitudes above 0; 99 percentile of all
  double median_speed = 0;                             ///< Median of all magnitudes
  double moving_share = 0;                             ///< Share of the values, 0 to 1, with at least kStillSpeedRatio of the fast speed
  bool is_unit_length = false, is_line_field = false;  ///< See the rules at the top of this file
  std::vector<Vec3> fastest_points;                    ///< Fastest point of each of the 3^3 parts of the box, world
};

/// Samples the grid.
VectorStats compute_vector_stats(const field::VectorGrid& grid);

}  // namespace catena::scene
