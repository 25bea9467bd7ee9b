/// The closest point of a level set where the domain of a cubic grid ends: on a face of its box, or of a cell beside one that a mask or a
/// value that is not finite makes invalid; on one face, or where two meet. There the search of isosurface/analytic.h goes on with
/// places, probe and gradient held to the wall:
///   minimise |x - p| on s(p) = level, index_a(p) = wall        (t within the wall is 0, the rest of t points out of it)
/// Faces of masked cells are held 1e-9 voxel before the face, so that the cell that is fetched is the valid one. Haptic thread.
#pragma once
#include "haptics/constraints/isosurface/analytic.h"

namespace catena::haptics {

struct AtWall {
  bool found = false;
  LevelPoint at;  ///< n is the normal of the level set itself, not of its cut with the wall
  Reason reason = Reason::none;
};

/// A wall lies less than a voxel ahead on the straight way along the surface to the place closest to the probe.
bool pushes_out(LevelField& field, const LevelPoint& at, const Vec3& probe) noexcept;

/// From `at` (valid, not a plateau), where a search stopped before the wall. Not found: no wall is near on the way, or on it the level
/// is not met, or only farther from the probe.
AtWall closest_at_wall(LevelField& field, const Vec3& probe, const ClosestGoal& goal, const LevelPoint& at) noexcept;

}  // namespace catena::haptics
