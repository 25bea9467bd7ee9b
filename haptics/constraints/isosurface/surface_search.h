// SPDX-License-Identifier: MIT
/// The closest point of a strongly folded level set to the probe x, where the quick iteration of isosurface/closest_point.h fails.
/// Every point kept is on the level; f = |x - p|^2 / 2 decreases from point to point:
///   u = (I + delta B)^-1 t in a trust region (|eigenvalues|), then back to the level along n: Newton, bisection inside a bracket
///   accepted: f decreases by at least 1e-4 t.u; near a minimum (I + delta B positive, |t| small): |t| decreases to 0.7
/// B is finite-difference after a rejected step, else SR1-updated. 2 to 6 field samples per iteration. Haptic thread.
#pragma once
#include "haptics/constraints/isosurface/closest_point.h"
#include "haptics/constraints/isosurface/level_set_field.h"

namespace catena::haptics {

/// Moves `at` (on the level to about 1e-9 L) to the closest point. Returns stuck where no step above the noise descends: a kink, or no
/// gradient.
ClosestPointResult descend_on_surface(LevelSetField& field, const Vec3& probe, const ClosestPointCriteria& goal, LevelPoint& at,
                                      Curvature& curvature) noexcept;

/// Search for the level from any point: march along the gradient (steps of at most r_max), bracket the sign change, Illinois inside
/// the bracket, keep the last valid normal on plateaus; where that fails, scan 26 directions outwards.
/// Lengths in world units, every field sample counted. Haptic thread.
///
/// Result of such a search.
struct LevelSetHit {
  bool found = false;
  LevelPoint point;
};

/// Returns the point on the level between a and b, where sigma has opposite signs (or is zero at one of them).
LevelSetHit find_root_between(LevelSetField& field, LevelPoint a, LevelPoint b) noexcept;

/// Marches from `start` at most `radius` far. `normal`: the last valid one, for plateaus; zero if there is none.
/// `reserve`: field samples left to other searches. Not found: `point` is where the march ended, if it is valid.
LevelSetHit search_along_gradient(LevelSetField& field, const LevelPoint& start, const Vec3& normal, double radius,
                                  int reserve = 32) noexcept;

/// Progress of a scan that takes more than one tick. Zero bytes: not begun.
struct SurfaceScan {
  Vec3 probe, center, nearest;  ///< position that it is made for; center of the scan; the sample nearest in value, or the point found
  /// Index of the next ring and direction: 27 per ring.
  std::int32_t next_direction;
  /// In progress; `nearest` is valid.
  bool in_progress, has_nearest;
  bool found_nothing;  ///< the scan for `probe` is complete without a result
  bool found_level;    ///< the scan has found the level for `probe`, in a later tick than it began in
};

/// Validates a scan from a file: see Constraint::is_sane.
inline bool is_sane(const SurfaceScan& scan) noexcept {
  return are_valid_bools(scan.in_progress, scan.has_nearest, scan.found_nothing, scan.found_level) && scan.next_direction >= 0 &&
         scan.next_direction < 1 << 20;
}

/// Scans 26 directions, or only the 6 axes, near before far, up to L from the center. Not found: `point` is the sample nearest in
/// value; if scan.in_progress, the scan is out of budget, and the next call resumes it.
LevelSetHit search_by_scan(LevelSetField& field, const LevelPoint& centre, bool axes_only, SurfaceScan& scan) noexcept;

}  // namespace catena::haptics
