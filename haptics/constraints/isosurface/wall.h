/// Where the domain of a cubic grid ends, at its box or beside a cell that a mask or a value that is not finite makes invalid. Along the
/// trilinear cells of the same samples, whose surface lies near the cubic's, to where walls hold that (isosurface/cell_walk.h); from there
/// onto the cubic's own level. Faces through the place that have nothing behind them are walls, and held:
///   minimise |x - p| on s(p) = level, index_a(p) = wall
/// by the search of isosurface/analytic.h with places, probe and gradient within the wall. Walls of invalid cells are held 1e-9 voxel
/// before the face, so that the cell that is fetched is the valid one. Haptic thread.
#pragma once
#include "haptics/constraints/isosurface/analytic.h"
#include "haptics/constraints/isosurface/cell_walk.h"

namespace catena::haptics {

inline constexpr int kForWalls = 24;  ///< fetches that this needs beside the walk

struct AtWall {
  bool found = false;
  LevelPoint at;                     ///< n is the normal of the level set itself, not of its cut with the wall
  Status status = Status::boundary;  ///< or budget: the walk goes on in the next tick
  Reason reason = Reason::none;
};

struct WayAllowed {
  Vec3 from{0.0};
  double room = 0;  ///< world units
};

/// From `at`, on the level to 1e-9 L. Not found: no wall holds it, or what is found is no nearer to the probe.
AtWall closest_at_walls(LevelField& field, const PieceFrames& frames, const Vec3& probe, const ClosestGoal& goal, const LevelPoint& at,
                        const WayAllowed& way) noexcept;

}  // namespace catena::haptics
