// SPDX-License-Identifier: MIT
/// Closest point at a domain wall of a cubic grid: the end of its box, or a cell made invalid by a mask or a value that is not finite.
/// Walks along the trilinear cells of the same samples, whose surface lies near the cubic's, up to the walls (isosurface/cell_walk.h); from
/// there onto the cubic's own level. Faces through the point that have nothing behind them are walls, and held:
///   minimize |x - p| on s(p) = level, index_a(p) = wall
/// by the search of isosurface/closest_point.h with points, probe and gradient within the wall. Walls of invalid cells are held 1e-9 voxel
/// before the face, so that the cell that is fetched is the valid one. Haptic thread.
#pragma once
#include "haptics/constraints/isosurface/cell_walk.h"
#include "haptics/constraints/isosurface/closest_point.h"

namespace catena::haptics {

inline constexpr int kWallFetches = 24;  ///< field samples needed besides those of the walk

/// Result of closest_point_at_walls.
struct WallResult {
  bool found = false;
  LevelPoint point;                          ///< held point; n is the normal of the level set itself, not of its intersection with the wall
  LinkStatus status = LinkStatus::boundary;  ///< boundary, or budget: the walk resumes in the next tick
  SampleStatus reason = SampleStatus::ok;
};

/// Limit of the proxy's motion in this tick.
struct AllowedTravel {
  /// Position of the proxy at the start of the tick, world units.
  Vec3 from{0.0};
  double max_distance = 0;  ///< world units
};

/// Searches from `at`, on the level to 1e-9 L. Not found: no wall holds the probe, or the point found is not nearer to the probe.
WallResult closest_point_at_walls(LevelSetField& field, const PieceFrames& frames, const Vec3& probe, const ClosestPointCriteria& goal,
                                  const LevelPoint& at, const AllowedTravel& travel) noexcept;

}  // namespace catena::haptics
