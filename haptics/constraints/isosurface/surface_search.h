/// The closest point of a strongly folded level set to the probe x, where the quick iteration of isosurface/analytic.h fails.
/// Every point kept is on the level; f = |x - p|^2 / 2 falls from point to point:
///   u = (I + delta B)^-1 t in a trust region (|eigenvalues|), then back to the level along n: Newton, halves inside a bracket
///   accepted: f falls by 1e-4 t.u at least; near a minimum (I + delta B positive, |t| small): |t| falls to 0.7
/// B is measured after a refusal, else learned. 2 to 6 fetches an iteration. Haptic thread.
#pragma once
#include "haptics/constraints/isosurface/closest_point.h"
#include "haptics/constraints/isosurface/level_set_field.h"

namespace catena::haptics {

/// From `at`, on the level to 1e-9 L or so. stuck: no step that can be told from noise goes down: a kink, or no gradient.
ClosestPointResult descend_on_surface(LevelSetField& field, const Vec3& probe, const ClosestPointCriteria& goal, LevelPoint& at,
                                      Curvature& curvature) noexcept;

/// From any point to the level: march along the gradient (steps of at most r_max), bracket the sign change, Illinois inside
/// the bracket, keep the last good normal on plateaus; where that fails, scan 26 directions outwards.
/// Lengths in world units, every fetch counted. Haptic thread.
struct LevelSetHit {
  bool found = false;
  LevelPoint point;
};

/// The level between a and b, where sigma has opposite signs (or is zero in one).
LevelSetHit find_root_between(LevelSetField& field, LevelPoint a, LevelPoint b) noexcept;

/// Marches from `start` at most `radius` far. `normal`: the last good one, for plateaus; zero if there is none.
/// `reserve`: fetches left to others. Not found: `at` is where the march ended, if it is valid.
LevelSetHit search_along_gradient(LevelSetField& field, const LevelPoint& start, const Vec3& normal, double radius,
                                  int reserve = 32) noexcept;

/// How far a scan has come that takes more than one tick. Zero bytes: not begun.
struct SurfaceScan {
  Vec3 probe, center, nearest;  ///< what it is made for; where it looks from; the sample nearest in value, or what was met
  std::int32_t next_direction;
  bool in_progress, has_nearest;
  bool found_nothing;  ///< has looked everywhere for `probe`
  bool found_level;    ///< has found the level for `probe`, in a later tick than it began in
};

/// Of a state from a file: see Constraint::is_valid_state.
inline bool is_sane(const SurfaceScan& scan) noexcept {
  return are_valid_bools(scan.in_progress, scan.has_nearest, scan.found_nothing, scan.found_level) && scan.next_direction >= 0 &&
         scan.next_direction < 1 << 20;
}

/// Looks along 26 directions, or along the 6 axes only, near before far, up to L from the centre. Not found: `at` is the sample
/// nearest in value; with scan.open the budget has ended the scan, and the next call goes on.
LevelSetHit search_by_scan(LevelSetField& field, const LevelPoint& centre, bool axes_only, SurfaceScan& scan) noexcept;

}  // namespace catena::haptics
