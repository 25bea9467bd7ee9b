/// What kind of vectors a grid holds, from what they look like: a flow, whose lengths are speeds, or fibres. The same grid always gives the
/// same answer. Off the tick, any thread.
///
/// TrialResult on at most about a quarter of a million vectors in blocks of 8^3 that are spread over the box, those of invalid cells and
/// those beyond the display range (engine/field/field_display_range.h) left out.
///   fibres   the 2 and the 99 percentile of the lengths above 0 are within 2 % of each other
///   axes     v and -v mean the same: of all neighbours along x, 0.1 % of fibres point to opposite sides (cosine below -0.5), of other
///   vectors
///            30 %; random signs give half of them, a flow next to none, vectors without any order a quarter
#pragma once
#include <vector>

#include "engine/field/grid/grid.h"

namespace catena::scene {

/// Of the fastest: where half of the field is slower, it stands still there.
inline constexpr double kStillSpeedRatio = 0.05;

struct VectorStats {
  double slow_speed = 0, fast_speed = 0;  ///< the 2 percentile of the magnitudes above 0, and the 99 of all
  double median_speed = 0;                ///< their median
  double moving_share = 0;                ///< share of the values: not still
  bool is_unit_length = false, is_line_field = false;
  std::vector<Vec3> fastest_points;  ///< world: the fastest place of each of 3^3 parts of the box
};

VectorStats compute_vector_stats(const field::VectorGrid& grid);

}  // namespace catena::scene
