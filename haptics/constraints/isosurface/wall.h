/// Where the domain of a cubic grid ends, at its box or beside a cell that a mask or a value that is not finite makes invalid: from a place
/// that a walk along trilinear cells of the same samples ended in (isosurface/cell_walk.h) onto the cubic's own level. Faces through the
/// place that have nothing behind them are walls, and held:
///   minimise |x - p| on s(p) = level, index_a(p) = wall
/// by the search of isosurface/analytic.h with places, probe and gradient within the wall. Walls of invalid cells are held 1e-9 voxel
/// before the face, so that the cell that is fetched is the valid one. Haptic thread.
#pragma once
#include "haptics/constraints/isosurface/analytic.h"

namespace catena::haptics {

struct AtWall {
  bool found = false;
  LevelPoint at;  ///< n is the normal of the level set itself, not of its cut with the wall
};

/// The place is f in [0, 1]^3 of the cell at `base`; exactly 0 or 1 on a face. Not found: the level is not met near by.
AtWall onto_level(LevelField& field, const Vec3& probe, const ClosestGoal& goal, const field::Index3& base, const Vec3& f) noexcept;

}  // namespace catena::haptics
