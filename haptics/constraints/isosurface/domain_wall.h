/// Where the domain of a cubic grid ends, at its box or beside a cell that a mask or a value that is not finite makes invalid. Along the
/// trilinear cells of the same samples, whose surface lies near the cubic's, to where walls hold that (isosurface/cell_walk.h); from there
/// onto the cubic's own level. Faces through the place that have nothing behind them are walls, and held:
///   minimise |x - p| on s(p) = level, index_a(p) = wall
/// by the search of isosurface/analytic.h with places, probe and gradient within the wall. Walls of invalid cells are held 1e-9 voxel
/// before the face, so that the cell that is fetched is the valid one. Haptic thread.
#pragma once
#include "haptics/constraints/isosurface/cell_walk.h"
#include "haptics/constraints/isosurface/closest_point.h"

namespace catena::haptics {

inline constexpr int kWallFetches = 24;  ///< fetches that this needs beside the walk

struct WallResult {
  bool found = false;
  LevelPoint point;                          ///< n is the normal of the level set itself, not of its cut with the wall
  LinkStatus status = LinkStatus::boundary;  ///< or budget: the walk goes on in the next tick
  SampleStatus reason = SampleStatus::ok;
};

struct AllowedTravel {
  Vec3 from{0.0};
  double max_distance = 0;  ///< world units
};

/// From `at`, on the level to 1e-9 L. Not found: no wall holds it, or what is found is no nearer to the probe.
WallResult closest_point_at_walls(LevelSetField& field, const PieceFrames& frames, const Vec3& probe, const ClosestPointCriteria& goal,
                                  const LevelPoint& at, const AllowedTravel& way) noexcept;

}  // namespace catena::haptics
